// SPDX-License-Identifier: Apache-2.0
#include "tests/accuracy/alarms.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "calib/design/experiment_design.h"
#include "calib/fit/joint/joint_fit.h"
#include "calib/validity/diff.h"
#include "calib/validity/validity_check.h"
#include "proto/units.h"

namespace mgtd::testing {
namespace {

constexpr std::size_t kStandard = 36, kDozen = 12;

calib::calibration::Calibration calibrated(const Scene& scene, std::uint64_t seed) {
  auto fitted = calib::fit::method_choice::fit(scene.run(seed), {});
  if (!fitted) throw std::runtime_error(fitted.error().text());
  return std::move(fitted->calibration);
}

/// Random poses of a run, as they would be taken a week later.
PoseTable dozen(const Scene& scene, std::uint64_t seed) {
  PoseTable table = scene.run(seed);
  table.poses = {table.poses.begin() + kStandard, table.poses.begin() + kStandard + kDozen};
  return table;
}

calib::validity::ValidityReport checked(const calib::calibration::Calibration& calibration,
                                        const PoseTable& table) {
  auto report = calib::validity::check(calibration, table, {});
  if (!report) throw std::runtime_error(report.error().text());
  return *std::move(report);
}

}  // namespace

Alarms alarms(const Scene& scene, int runs) {
  constexpr const char* kMoved = "s2 iy";
  Alarms out;
  out.runs = runs;
  for (int run = 0; run < runs; ++run) {
    const auto seed = 100'000 + 4 * static_cast<std::uint64_t>(run);
    const calib::calibration::Calibration old = calibrated(scene, seed);
    const calib::validity::ValidityReport same = checked(old, dozen(scene, seed + 1));
    out.false_check += same.valid ? 0 : 1;
    out.false_diff += calib::validity::diff(old, calibrated(scene, seed + 2)).changed ? 1 : 0;
    // The same poses with the change that they are said to show.
    const auto& all = same.change.parameters;
    const auto found = std::find_if(all.begin(), all.end(), [](const auto& p) { return p.name == kMoved; });
    Scene later = scene;
    later.rig[1][7] += found->seen;
    out.size_nT += found->seen / runs;
    const calib::validity::ValidityReport moved = checked(old, dozen(later, seed + 1));
    out.seen_check += moved.valid ? 0 : 1;
    const auto& named = moved.change.named;
    out.named_check += !named.empty() && named.front().name == kMoved ? 1 : 0;
  }
  return out;
}

Foretold foretold(const Scene& scene, int runs) {
  const std::vector<AttitudeDeg> attitudes = standard_run(scene.poses - kStandard, 7);
  const auto simulate = [&](std::uint64_t seed) {
    PoseTable table =
        measure(scene.rig, scene.site, attitudes, kStandard,
                {Noise::Kind::gaussian, scene.noise_nT, scene.table_sd_deg, scene.f_sd_nT}, seed);
    for (Pose& pose : table.poses) pose.sd_nT = {};
    return table;
  };
  const auto truth = models_of(scene.rig);
  calib::design::DesignRequest request;
  request.poses = simulate(1);
  request.f_nT = scene.site.f_nT;
  request.inclination_rad = to_rad(scene.site.inclination_deg);
  request.declination_rad = to_rad(scene.site.declination_deg);
  request.pose_noise_nT = scene.noise_nT;
  request.scalar_sd_nT = scene.f_sd_nT;
  request.table_sd_rad = to_rad(scene.table_sd_deg);
  request.sensors = truth;
  const auto planned = calib::design::evaluate_design(request);
  if (!planned || !planned->determined) throw std::runtime_error("the plan does not determine the rig");
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(calib::fit::joint::FixedSlots{}.sensor_block());
  for (int run = 0; run < runs; ++run) {
    const auto fit = calib::fit::joint::fit_joint(simulate(200'000 + static_cast<std::uint64_t>(run)), {});
    if (!fit) throw std::runtime_error(fit.error().text());
    for (int j = 0; j < calib::fit::joint::FixedSlots{}.sensor_block(); ++j) {
      const auto i = static_cast<std::size_t>(j / calib::sensor::kSensorParameters);
      const int p = j % calib::sensor::kSensorParameters;
      const calib::design::Expected& expected = planned->parameters[static_cast<std::size_t>(j)];
      const double sd = expected.sd * (expected.unit == "deg" ? kRadiansPerDegree : 1);
      const double error = fit->state.sensors[i].parameters()[p] - truth[i].parameters()[p];
      sum[j] += error * error / (sd * sd) / runs;
    }
  }
  return {.runs = runs,
          .rms_ratio = std::sqrt(sum.mean()),
          .lowest = std::sqrt(sum.minCoeff()),
          .highest = std::sqrt(sum.maxCoeff()),
          .expected_spread = 1 / std::sqrt(2.0 * runs)};
}

}  // namespace mgtd::testing
