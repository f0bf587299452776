// SPDX-License-Identifier: Apache-2.0
#include "tests/accuracy/contamination.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <stdexcept>

#include "calib/fit/joint/joint_fit.h"
#include "calib/fit/method_choice/fit.h"
#include "proto/units.h"

namespace mgtd::testing {
namespace {

constexpr std::uint64_t kFirstSeed = 7000;

double& reading_of(Pose& pose, int channel) {
  return pose.y_nT.at(static_cast<std::size_t>(channel / 3))[channel % 3];
}

bool scattered(Gross kind) {
  return kind == Gross::axis || kind == Gross::pose || kind == Gross::scattered_sensor;
}

/// The poses that are hit: scattered, or one stretch.
std::vector<std::size_t> poses_hit(std::size_t poses, const Contamination& what, std::mt19937_64& random) {
  const auto count = static_cast<std::size_t>(
      what.share > 0 ? std::max(1.0, std::round(what.share * static_cast<double>(poses))) : 0);
  std::vector<std::size_t> all(poses);
  std::iota(all.begin(), all.end(), 0U);
  if (scattered(what.kind)) {
    for (std::size_t k = 0; k < count; ++k) std::swap(all[k], all[k + random() % (poses - k)]);
    all.resize(count);
    return all;
  }
  const std::size_t from = random() % (poses - count + 1);
  return {all.begin() + static_cast<std::ptrdiff_t>(from),
          all.begin() + static_cast<std::ptrdiff_t>(from + count)};
}

std::bitset<12> channels_hit(Gross kind, std::mt19937_64& random) {
  std::bitset<12> out;
  if (kind == Gross::axis) out.set(random() % 12);
  if (kind == Gross::sensor || kind == Gross::scattered_sensor)
    out = std::bitset<12>(0b111U << (3 * (random() % 4)));
  if (kind == Gross::pose || kind == Gross::stretch) out.set();
  return out;
}

/// Least squares at the true weights without what is bad.
PerSensor<calib::sensor::SensorModel> oracle(const Spoilt& run, const Scene& scene) {
  calib::fit::joint::JointOptions options;
  options.table_sd_rad = to_rad(scene.table_sd_deg);
  auto problem = calib::fit::joint::joint_problem(run.table, options);
  if (!problem) throw std::runtime_error(problem.error().text());
  calib::fit::joint::fix_gauge(*problem, options);
  calib::fit::joint::weight_by_pose(*problem,
                                    calib::calibration::AxisNoise::Constant(kSensors, 3, scene.noise_nT));
  std::vector<calib::fit::joint::JointPose> kept;
  for (std::size_t k = 0; k < run.bad.size(); ++k) {
    calib::fit::joint::JointPose pose = problem->poses[k];
    for (std::size_t c = 0; c < 12; ++c)
      if (run.bad[k][c]) pose.weight[static_cast<Eigen::Index>(c)] = 0;
    if (!run.bad[k].all()) kept.push_back(pose);
  }
  problem->poses = std::move(kept);
  const auto n =
      calib::fit::joint::direction_of(to_rad(scene.site.inclination_deg), to_rad(scene.site.declination_deg));
  calib::fit::joint::JointState state =
      calib::fit::joint::joint_state(*problem, models_of(scene.rig), n, scene.site.f_nT);
  const auto solution = calib::fit::joint::solve(*problem, std::move(state));
  if (!solution) throw std::runtime_error(solution.error().text());
  return solution->state.sensors;
}

/// Whether what is spoilt is one stretch that leaves fewer good poses than that before or after it.
bool at_an_end(const Spoilt& run, Gross kind) {
  constexpr std::ptrdiff_t kWithin = 3;
  if (scattered(kind)) return false;
  const auto bad = [](const std::bitset<12>& channels) { return channels.any(); };
  const auto first = std::find_if(run.bad.begin(), run.bad.end(), bad);
  const auto last = std::find_if(run.bad.rbegin(), run.bad.rend(), bad);
  return first - run.bad.begin() < kWithin || last - run.bad.rbegin() < kWithin;
}

/// Good readings that are left out.
int good_left_out(const calib::fit::FitReport& report, const Spoilt& run) {
  int out = 0;
  for (const calib::fit::OutlierNode& node : report.outliers) {
    const std::bitset<12>& bad = run.bad.at(static_cast<std::size_t>(node.pose - 1));
    for (std::size_t c = 0; c < 12; ++c) {
      const std::string sensor = "s" + std::to_string(c / 3 + 1);
      const bool meant =
          node.where == "pose" || node.where == sensor || node.where == sensor + "." + "xyz"[c % 3];
      out += meant && !bad[c] ? 1 : 0;
    }
  }
  return out;
}

}  // namespace

std::string name(Gross kind) {
  switch (kind) {
    case Gross::axis:
      return "one axis, scattered poses";
    case Gross::sensor:
      return "one sensor, one stretch";
    case Gross::pose:
      return "all readings, scattered poses";
    case Gross::stretch:
      return "all readings, one stretch";
    case Gross::scattered_sensor:
      return "one sensor, scattered poses";
  }
  return "";
}

Spoilt spoilt(PoseTable table, const Contamination& what, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Spoilt out{std::move(table), {}};
  out.bad.resize(out.table.poses.size());
  const std::vector<std::size_t> hit = poses_hit(out.bad.size(), what, random);
  const std::bitset<12> channels = channels_hit(what.kind, random);
  std::array<double, 12> sign{};
  const auto draw = [&] {
    for (double& s : sign) s = random() % 2 == 0 ? 1 : -1;
  };
  draw();
  for (std::size_t j = 0; j < hit.size(); ++j) {
    if (scattered(what.kind)) draw();
    const double passed = (static_cast<double>(j) + 0.5) / static_cast<double>(hit.size());
    const double size =
        what.size_nT * (what.kind == Gross::stretch ? std::sin(std::numbers::pi * passed) : 1.0);
    for (std::size_t c = 0; c < 12; ++c) {
      if (channels[c]) reading_of(out.table.poses[hit[j]], static_cast<int>(c)) += size * sign.at(c);
    }
    out.bad[hit[j]] = channels;
  }
  return out;
}

Scene contaminated_scene() {
  Scene scene;
  scene.noise_nT = 0.05;
  scene.spreads = true;
  return scene;
}

Robustness robustness(const Contamination& what, int runs) {
  const Scene scene = contaminated_scene();
  Robustness out;
  out.runs = runs;
  double found = 0, least = 0, good = 0, away_found = 0, away_least = 0;
  for (int run = 0; run < runs; ++run) {
    const std::uint64_t seed = kFirstSeed + static_cast<std::uint64_t>(run);
    const Spoilt data = spoilt(scene.run(seed), what, seed);
    const auto report = calib::fit::method_choice::fit(data.table, {});
    if (!report || !report->calibration.accepted_by_checks) {
      ++out.refused;
      continue;
    }
    const double own = tensor_mean_square(report->calibration.sensors, scene).sum();
    const double best = tensor_mean_square(oracle(data, scene), scene).sum();
    found += own, least += best;
    if (at_an_end(data, what.kind))
      ++out.at_an_end;
    else
      away_found += own, away_least += best;
    out.worst = std::max(out.worst, std::sqrt(own / best));
    good += good_left_out(*report, data);
  }
  const int accepted = runs - out.refused;
  if (accepted == 0) return out;
  out.ratio = std::sqrt(found / least);
  if (away_least > 0) out.away_ratio = std::sqrt(away_found / away_least);
  out.good_left_out = good / (12.0 * static_cast<double>(scene.poses) * accepted);
  return out;
}

}  // namespace mgtd::testing
