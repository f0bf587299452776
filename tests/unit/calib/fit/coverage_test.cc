// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "calib/fit/method_choice/fit.h"
#include "calib/report/fit_reasons.h"
#include "tests/unit/calib/fit/simulated_poses.h"

/// Data that cannot carry a calibration: refused, or given with a check that fails, a reason in the
/// operator's words, and the poses to add.
namespace mgtd::calib::fit {
namespace {

using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::Simulation;

PoseTable at(const Simulation& sim, const std::vector<TableAngles>& poses) {
  std::mt19937_64 rng(5);
  PoseTable table;
  for (const TableAngles& angles : poses)
    table.poses.push_back(measure(sim, angles, static_cast<int>(table.poses.size()) + 1, 0, rng));
  return table;
}

std::vector<TableAngles> nearly_level(double tilt_deg, int count) {
  std::mt19937_64 rng(5);
  std::uniform_real_distribution<double> tilt(-to_rad(tilt_deg), to_rad(tilt_deg)), turn(-3.1, 3.1);
  std::vector<TableAngles> out;
  for (int k = 0; k < count; ++k) out.push_back({turn(rng), tilt(rng), tilt(rng)});
  return out;
}

const Check* failed(const FitReport& report, std::string_view name) {
  for (const Check& check : report.calibration.checks)
    if (check.name == name && !check.passed) return &check;
  return nullptr;
}

TEST(Coverage, OneAxisIsRefusedWhicheverItIs) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<TableAngles> poses;
    for (int k = 0; k < 72; ++k) {
      const double a = to_rad(5 * k);
      poses.push_back({axis == 0 ? a : 0, axis == 1 ? a : 0, axis == 2 ? a : 0});
    }
    const auto report = method_choice::fit(at({.table_sd_rad = to_rad(0.1)}, poses), {});
    ASSERT_FALSE(report) << axis;
    EXPECT_EQ(report.error().code, ErrorCode::refused);
    EXPECT_THAT(report.error().remedy, HasSubstr("axis"));
  }
}

TEST(Coverage, LevelFlightIsNotAcceptedAndSaysWhatToAdd) {
  const auto report =
      method_choice::fit(at({.noise_nT = 10, .table_sd_rad = to_rad(0.1)}, nearly_level(2.5, 100)), {});
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_FALSE(report->calibration.accepted_by_checks);
  const Check* const check = failed(*report, "coverage");
  ASSERT_NE(check, nullptr);
  EXPECT_THAT(check->measured, HasSubstr("of all sensors with offset"));
  EXPECT_THAT(check->measured, HasSubstr("platform +Z"));
  EXPECT_THAT(check->remedy, HasSubstr("pitch"));
}

/// Better noise makes the same attitudes enough for a number, and the number is honest.
TEST(Coverage, LevelFlightsUncertaintyIsTheRealOne) {
  const Simulation sim{.noise_nT = 0.2, .table_sd_rad = to_rad(0.1)};
  double squares = 0, largest = 0;
  constexpr int kRuns = 20;
  for (int run = 0; run < kRuns; ++run) {
    std::mt19937_64 rng(100 + static_cast<std::uint64_t>(run));
    PoseTable table;
    for (const TableAngles& a : nearly_level(20, 100))
      table.poses.push_back(measure(sim, a, static_cast<int>(table.poses.size()) + 1, 0, rng));
    const auto report = method_choice::fit(table, {});
    ASSERT_TRUE(report) << report.error().text();
    const auto& c = report->calibration;
    const double sd = std::sqrt(c.covariance(sensor::cz, sensor::cz));
    squares += std::pow((c.sensors[0].scale[2] - sim.rig[0].scale[2]) / sd, 2) / kRuns;
    largest = std::max(largest, sd);
  }
  EXPECT_NEAR(squares, 1, 1.0);  // 3 sqrt(2/20)
  EXPECT_GT(largest, 2e-5);      // the whole sphere gives 5e-7 at this noise
}

TEST(Coverage, NearThePoleALevelTurnTellsNothing) {
  Simulation sim{.inclination_rad = to_rad(89.7), .table_sd_rad = to_rad(0.1)};
  const auto level = method_choice::fit(at(sim, nearly_level(2, 100)), {});
  ASSERT_FALSE(level);
  EXPECT_THAT(level.error().message, HasSubstr("the readings lie on a plane"));
  // Turned over in all directions the field's direction does not matter.
  const auto whole = method_choice::fit(simulate(sim, 36, 121, 3), {});
  ASSERT_TRUE(whole) << whole.error().text();
  EXPECT_TRUE(whole->calibration.accepted_by_checks) << ::testing::PrintToString(report::fit_reasons(*whole));
}

TEST(Coverage, WithoutAFieldTheFreeScaleIsSaid) {
  const auto report = method_choice::fit(testing::simulate({.with_f = false}, 36, 121, 3), {});
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_THAT(report::fit_reasons(*report), Contains(HasSubstr("overall scale is free")));
}

/// Constant readings, and readings near one point: |b| can be made constant exactly, by a gain that vanishes
/// and an offset that grows without limit.
TEST(Coverage, DataThatOnlyTheTrivialSolutionFitsAreRefused) {
  std::vector<TableAngles> poses = nearly_level(0.05, 60);
  for (TableAngles& a : poses) a.azimuth_rad = 0.01 * a.azimuth_rad;
  const auto near_a_point = method_choice::fit(at({.noise_nT = 20}, poses), {});
  ASSERT_FALSE(near_a_point);
  EXPECT_THAT(near_a_point.error().message, HasSubstr("the fit wants a volume gain of"));

  PoseTable stuck = testing::simulate({.table_sd_rad = to_rad(0.1)}, 36, 121, 3);
  for (Pose& pose : stuck.poses) pose.y_nT[2] = {100, 200, 300};
  const auto report = method_choice::fit(stuck, {});
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error().message, HasSubstr("sensor 3"));

  PoseTable twice = testing::simulate({.table_sd_rad = to_rad(0.1)}, 36, 121, 3);
  for (Pose& pose : twice.poses) pose.y_nT[1][1] = pose.y_nT[1][0];
  const auto wired = method_choice::fit(twice, {});
  ASSERT_FALSE(wired);
  EXPECT_THAT(wired.error().message, HasSubstr("sensor 2"));
}

TEST(Coverage, ASensorBetweenTwoMountingsIsNamed) {
  Simulation sim{.table_sd_rad = to_rad(0.1)};
  sim.rig[2].gamma_rad = to_rad(44);
  const auto report = method_choice::fit(simulate(sim, 36, 121, 3), {});
  ASSERT_TRUE(report) << report.error().text();
  const Check* const check = failed(*report, "mounting");
  ASSERT_NE(check, nullptr);
  EXPECT_THAT(check->measured, HasSubstr("s3"));
}

}  // namespace
}  // namespace mgtd::calib::fit
