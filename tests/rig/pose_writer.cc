// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/pose_writer.h"

#include <fmt/format.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/rig/rotations.h"
#include "tests/rig/world.h"

namespace mgtd::rig {
namespace {

struct PlannedPose {
  std::array<double, 3> angles_deg{};  ///< azimuth, pitch, roll
  bool standard{false};
  double dwell_s{4};
};

std::vector<PlannedPose> run_of_157(std::uint64_t seed, double tilt_limit_deg) {
  std::vector<PlannedPose> out;
  for (int k = 0; k < 18; ++k) out.push_back({{20.0 * k, 0, 0}, true, 4});
  for (int k = 17; k >= 0; --k) out.push_back({{20.0 * k + 10, 0, 0}, true, 4});
  std::mt19937_64 random(seed ^ 0x9e3779b97f4a7c15U);
  std::uniform_real_distribution<double> unit(0, 1);
  constexpr std::size_t kRandom = 121, kRevisits = 24, kFirst = 36;
  for (std::size_t k = 0; k < kRandom; ++k) {
    PlannedPose pose{{360 * unit(random), std::asin(2 * unit(random) - 1) / kDeg, 360 * unit(random) - 180},
                     false,
                     k % 2 == 0 ? 4.0 : 8.0};
    for (std::size_t axis : {pitch, roll})
      pose.angles_deg.at(axis) = std::clamp(pose.angles_deg.at(axis), -tilt_limit_deg, tilt_limit_deg);
    if (k >= kRandom - 2 * kRevisits && k % 2 == 1) {
      pose.angles_deg = out.at(kFirst + static_cast<std::size_t>(
                                            unit(random) * static_cast<double>(kRandom - 2 * kRevisits)))
                            .angles_deg;
    }
    out.push_back(pose);
  }
  return out;
}

std::vector<PlannedPose> grid_of_5832() {
  std::vector<PlannedPose> out;
  for (int r = 0; r < 18; ++r) {
    for (int p = 0; p < 18; ++p) {
      for (int a = 0; a < 18; ++a) out.push_back({{20.0 * a, 20.0 * p, 20.0 * r}, r == 0 && p == 0, 0});
    }
  }
  return out;
}

struct Means {
  std::array<Eigen::Vector3d, 4> mean{}, sd{};
  double f_nT{0};
  int n{1};
};

Means dwell(World& world, double from_s, double length_s) {
  const double period = 1 / world.scenario().rate_hz;
  Means out;
  out.n = std::max(1, static_cast<int>(std::lround(length_s / period)));
  for (int i = 0; i < 4; ++i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
    const Eigen::Vector3d first = world.read_sensor(i, from_s);
    for (int k = 0; k < out.n; ++k) {
      const Eigen::Vector3d d = k == 0 ? Eigen::Vector3d::Zero()
                                       : Eigen::Vector3d(world.read_sensor(i, from_s + k * period) - first);
      sum += d;
      squares += d.cwiseAbs2();
    }
    const double n = out.n;
    out.mean.at(static_cast<std::size_t>(i)) = first + sum / n;
    out.sd.at(static_cast<std::size_t>(i)) =
        out.n > 1 ? Eigen::Vector3d(((squares - sum.cwiseAbs2() / n) / (n - 1)).cwiseSqrt())
                  : Eigen::Vector3d::Zero();
  }
  out.f_nT = world.read_scalar(from_s + length_s / 2);
  return out;
}

constexpr double kSettle_s = 1;

std::string header() {
  std::string out = "pose,set,t_s,azimuth_deg,pitch_deg,roll_deg,f_nT,n";
  for (int i = 1; i <= 4; ++i) out += fmt::format(",s{0}_x_nT,s{0}_y_nT,s{0}_z_nT", i);
  for (int i = 1; i <= 4; ++i) out += fmt::format(",s{0}_sd_x_nT,s{0}_sd_y_nT,s{0}_sd_z_nT", i);
  for (int i = 1; i <= 4; ++i) out += fmt::format(",s{}_T_degC", i);
  return out + ",sense,dwell_s,since_stop_s\n";
}

/// Goes to a pose; returns when the table stands there.
double go(World& world, const PlannedPose& pose, double t_s) {
  for (const TableAxis axis : {azimuth, pitch, roll}) world.move(axis, pose.angles_deg.at(axis), t_s);
  double arrived_s = t_s;
  while (world.moving(arrived_s)) arrived_s += 0.05;
  return arrived_s;
}

std::string row(const World& world, int number, const PlannedPose& pose, double begin_s, const Means& means) {
  const double middle_s = begin_s + pose.dwell_s / 2;
  std::string out = fmt::format("{},{},{:.3f},{:.6f},{:.6f},{:.6f},{:.3f},{}", number,
                                pose.standard ? "standard" : "random", middle_s, pose.angles_deg[azimuth],
                                pose.angles_deg[pitch], pose.angles_deg[roll], means.f_nT, means.n);
  for (const auto& y : means.mean) out += fmt::format(",{:.5f},{:.5f},{:.5f}", y[0], y[1], y[2]);
  for (const auto& sd : means.sd)
    out += means.n > 1 ? fmt::format(",{:.5f},{:.5f},{:.5f}", sd[0], sd[1], sd[2]) : ",,,";
  for (int i = 0; i < 4; ++i) out += fmt::format(",{:.4f}", world.head_degC(i, middle_s));
  const int sense = world.axis(azimuth).sense();
  return out + fmt::format(",{},{},{:.3f}\n", sense == 0 ? std::string() : std::to_string(sense),
                           pose.dwell_s, kSettle_s + pose.dwell_s / 2);
}

}  // namespace

std::string pose_table_csv(const Scenario& scenario, PoseSet set) {
  Scenario used = scenario;
  if (set == PoseSet::grid5832) used.table_accuracy_deg = 0;
  World world(used);
  std::string out = header();
  double t_s = 0;
  int number = 0;
  for (const PlannedPose& pose :
       set == PoseSet::grid5832 ? grid_of_5832() : run_of_157(used.seed, used.tilt_limit_deg)) {
    const double begin_s = go(world, pose, t_s) + kSettle_s;
    const Means means = dwell(world, begin_s, pose.dwell_s);
    t_s = begin_s + pose.dwell_s;
    out += row(world, ++number, pose, begin_s, means);
  }
  return out;
}

}  // namespace mgtd::rig
