// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/simulated_table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/rig/rotations.h"
#include "tests/rig/world.h"
#include "tests/rig/wrong_rows.h"

namespace mgtd::rig {
namespace {

struct Node {
  double at, weight;  ///< of a unit interval
};
constexpr std::array<Node, 5> kNodes{{{0.04691007703066800, 0.11846344252809454},
                                      {0.23076534494715845, 0.23931433524968324},
                                      {0.5, 0.28444444444444444},
                                      {0.76923465505284155, 0.23931433524968324},
                                      {0.95308992296933200, 0.11846344252809454}}};
constexpr double kOvershoot_deg = 10;
constexpr double kScalarResolution_nT = 1e-3;
constexpr double kScalarLeast_nT = 20'000;  ///< a scalar magnetometer shows nothing below
constexpr double kPathStep_s = 0.25;        ///< of the recorded path

void round_means(Survey& survey, double step_nT) {
  for (SurveyRow& row : survey.rows)
    for (Eigen::Vector3d& y_nT : row.y_nT) y_nT = step_nT * (y_nT / step_nT).array().round().matrix();
}

class Surveyor {
 public:
  Surveyor(Scenario scenario, const Design& design, Sampling sampling)
      : world_(std::move(scenario)), design_(design), sampling_(sampling), now_s_(design.begin_s) {}
  [[nodiscard]] Survey survey();

 private:
  void go(const PlannedPose& pose);
  void move_to(const std::array<double, 3>& target_deg);
  void record_path(double until_s);
  void measure(const PlannedPose& planned, SurveyRow& pose);
  void by_means(int i, const PlannedPose& planned, int n, SurveyRow& pose);
  void by_samples(int i, int n, SurveyRow& pose);
  void scalar(const PlannedPose& planned, SurveyRow& pose);
  void reference(const PlannedPose& planned, SurveyRow& pose);
  [[nodiscard]] TableAngles recorded_angles(double t_s) const;
  [[nodiscard]] const Scenario& scenario() const { return world_.scenario(); }

  World world_;
  const Design& design_;
  Sampling sampling_;
  double now_s_;
  std::size_t mount_{0};
  std::vector<PathPoint> path_;
};

/// As the table indicates it, not as it truly is.
TableAngles Surveyor::recorded_angles(double t_s) const {
  std::array<double, 3> deg{};
  for (const TableAxis axis : {azimuth, pitch, roll}) deg.at(axis) = world_.axis(axis).indicated_deg(t_s);
  const Eigen::Matrix3d& mount = design_.mounts.at(mount_);
  if (mount.isIdentity(0)) return {deg[0] * kDeg, deg[1] * kDeg, deg[2] * kDeg};
  return recorded_angles_of(mount * about_z(deg[azimuth]) * about_y(deg[pitch]) * about_x(deg[roll]));
}

void Surveyor::record_path(double until_s) {
  if (!design_.record_path) return;
  for (double t = now_s_; t < until_s; t += kPathStep_s) path_.push_back({t, recorded_angles(t)});
  path_.push_back({until_s, recorded_angles(until_s)});
}

void Surveyor::move_to(const std::array<double, 3>& target_deg) {
  for (const TableAxis axis : {azimuth, pitch, roll}) world_.move(axis, target_deg.at(axis), now_s_);
  const double arrival_s = std::max(now_s_, world_.arrival_s());
  record_path(arrival_s);
  now_s_ = arrival_s;
}

void Surveyor::go(const PlannedPose& pose) {
  now_s_ += pose.pause_s;
  if (pose.cage_nT) {
    world_.set_cage(*pose.cage_nT, now_s_);
    now_s_ += design_.settle_s;
    return;
  }
  const auto mount = static_cast<std::size_t>(pose.mount - 1);
  if (mount != std::exchange(mount_, mount)) world_.remount(design_.mounts.at(mount), now_s_);
  const double here_deg = world_.axis(azimuth).indicated_deg(now_s_);
  const double way_deg = pose.angles_deg[azimuth] - here_deg;
  if (pose.sense != 0 && way_deg * pose.sense <= 0) {
    auto beyond_deg = pose.angles_deg;
    beyond_deg[azimuth] -= kOvershoot_deg * pose.sense;
    move_to(beyond_deg);
  }
  move_to(pose.angles_deg);
  now_s_ += design_.settle_s + pose.wait_s;
}

void Surveyor::by_means(int i, const PlannedPose& planned, int n, SurveyRow& pose) {
  const auto s = static_cast<std::size_t>(i);
  const double length_s = planned.dwell_s;
  Eigen::Vector3d mean(0, 0, 0), spread(0, 0, 0);
  std::array<Eigen::Vector3d, kNodes.size()> at_node;
  for (std::size_t k = 0; k < kNodes.size(); ++k) {
    at_node.at(k) = world_.quiet_reading(i, now_s_ + kNodes.at(k).at * length_s);
    mean += kNodes.at(k).weight * (at_node.at(k) - at_node[0]);
  }
  mean += at_node[0];
  for (std::size_t k = 0; k < kNodes.size(); ++k)
    spread += kNodes.at(k).weight * (at_node.at(k) - mean).cwiseAbs2();
  const auto dwell = world_.noise(i).dwell(mean, now_s_, n, 1 / scenario().rate_hz);
  pose.y_nT.at(s) = dwell.mean_nT;
  if (n < 2) return;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    pose.sd_nT.at(s).at(a) = std::sqrt(dwell.sd_nT[axis] * dwell.sd_nT[axis] + spread[axis]);
  }
}

void Surveyor::by_samples(int i, int n, SurveyRow& pose) {
  const auto s = static_cast<std::size_t>(i);
  Eigen::Vector3d sum(0, 0, 0), squares(0, 0, 0), first(0, 0, 0);
  for (int k = 0; k < n; ++k) {
    const Eigen::Vector3d y = world_.read_sensor(i, now_s_ + k / scenario().rate_hz);
    if (k == 0) first = y;
    sum += y - first;
    squares += (y - first).cwiseAbs2();
  }
  pose.y_nT.at(s) = first + sum / n;
  if (n < 2) return;
  const Eigen::Vector3d variance = (squares - sum.cwiseAbs2() / n) / (n - 1);
  for (std::size_t a = 0; a < 3; ++a)
    pose.sd_nT.at(s).at(a) = std::sqrt(std::max(0.0, variance[static_cast<Eigen::Index>(a)]));
}

/// Its readings come once a period; their mean.
void Surveyor::scalar(const PlannedPose& planned, SurveyRow& pose) {
  if (!scenario().scalar) return;
  const double readings = std::max(1.0, std::floor(planned.dwell_s / scenario().scalar_period_s));
  double mean = 0;
  for (const Node& node : kNodes)
    mean += node.weight * world_.quiet_scalar(now_s_ + node.at * planned.dwell_s);
  const double sd_nT = scenario().scalar_noise_nT / std::sqrt(readings);
  if (planned.cage_nT && mean < kScalarLeast_nT) return;
  pose.f_nT = mean + sd_nT * world_.scalar_noise();
  pose.f_sd_nT = std::max(kScalarResolution_nT, sd_nT);
}

/// Over the dwell as the others; its noise is that of the mean.
void Surveyor::reference(const PlannedPose& planned, SurveyRow& pose) {
  if (!scenario().reference) return;
  Eigen::Vector3d mean(0, 0, 0);
  for (const Node& node : kNodes)
    mean += node.weight * world_.quiet_reference(now_s_ + node.at * planned.dwell_s);
  const double sd_nT = scenario().reference->sd_nT;
  pose.ref_nT = mean + sd_nT * world_.reference_noise();
  pose.ref_sd_nT = std::max(kScalarResolution_nT, sd_nT);
}

void Surveyor::measure(const PlannedPose& planned, SurveyRow& pose) {
  const double middle_s = now_s_ + planned.dwell_s / 2;
  const int n = std::max(1, static_cast<int>(std::lround(planned.dwell_s * scenario().rate_hz)));
  for (int i = 0; i < static_cast<int>(world_.sensors()); ++i) {
    if (i > 0 && scenario().copied > 0) {
      pose.y_nT.at(static_cast<std::size_t>(i)) = pose.y_nT[0];
      pose.sd_nT.at(static_cast<std::size_t>(i)) = pose.sd_nT[0];
    } else if (sampling_ == Sampling::means) {
      by_means(i, planned, n, pose);
    } else {
      by_samples(i, n, pose);
    }
    pose.T_degC.at(static_cast<std::size_t>(i)) = world_.head_degC(i, middle_s);
  }
  scalar(planned, pose);
  reference(planned, pose);
  if (scenario().angles) {
    const TableAngles angles = recorded_angles(middle_s);
    pose.azimuth_rad = angles.azimuth_rad;
    pose.pitch_rad = angles.pitch_rad;
    pose.roll_rad = angles.roll_rad;
  }
  pose.t_s = middle_s;
  pose.n = n;
  const double rho = scenario().noise.ar1_rho;
  if (rho != 0 && n > 1 && scenario().noise.tells_n_eff)
    pose.n_eff = std::max(1.0, n * (1 - rho) / (1 + rho));
  if (const int sense = world_.axis(azimuth).sense(); sense != 0) pose.sense = sense;
  if (planned.dwell_s > 0) pose.dwell_s = planned.dwell_s;
  if (!planned.cage_nT) pose.since_stop_s = design_.settle_s + planned.wait_s + planned.dwell_s / 2;
  for (const Covariate& c : scenario().covariates) {
    double mean = 0;
    for (const Node& node : kNodes) mean += node.weight * c.at(now_s_ + node.at * planned.dwell_s);
    if (c.recorded) pose.covariates[c.name] = mean;
  }
}

Survey Surveyor::survey() {
  Survey out{.sensors = world_.sensors(), .rows = {}};
  out.turned = design_.poses.empty() || !design_.poses.front().cage_nT;
  out.angles = scenario().angles;
  out.scalar = scenario().scalar || !scenario().reference;
  const bool remounted = design_.mounts.size() > 1;
  world_.remount(design_.mounts.at(0), now_s_);
  for (const PlannedPose& planned : design_.poses) {
    go(planned);
    SurveyRow pose(world_.sensors());
    pose.number = static_cast<int>(out.rows.size()) + 1;
    pose.set = planned.set;
    measure(planned, pose);
    if (remounted) pose.mount = planned.mount;
    now_s_ += planned.dwell_s;
    out.rows.push_back(std::move(pose));
  }
  if (scenario().apart) turn_apart(out, scenario().seed);
  for (const GrossReading& gross : scenario().gross) spoil(out, gross, scenario());
  if (scenario().noise.mean_step_nT > 0) round_means(out, scenario().noise.mean_step_nT);
  out.path = std::move(path_);
  return out;
}

}  // namespace

TableAngles recorded_angles_of(const Eigen::Matrix3d& R) {
  return {std::atan2(-R(1, 0), R(0, 0)), std::asin(std::clamp(R(2, 0), -1.0, 1.0)),
          std::atan2(-R(2, 1), R(2, 2))};
}

Survey simulated_survey(Scenario scenario, const Design& design, std::uint64_t seed, Sampling sampling) {
  scenario.seed = seed;
  return Surveyor(std::move(scenario), design, sampling).survey();
}

PoseTable simulated_table(Scenario scenario, const Design& design, std::uint64_t seed, Sampling sampling) {
  return pose_table_of(simulated_survey(std::move(scenario), design, seed, sampling));
}

}  // namespace mgtd::rig
