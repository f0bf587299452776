// SPDX-License-Identifier: Apache-2.0
#include "calib/validity/diff.h"

#include <gmock/gmock.h>

#include "calib/effects/library/library.h"
#include "calib/fit/method_choice/fit.h"
#include "calib/report/change_report.h"
#include "calib/report/diff_report.h"
#include "tests/unit/calib/fit/simulated_poses.h"
#include "tests/unit/calib/validity/first_sensor.h"

namespace mgtd::calib::validity {
namespace {

using ::testing::HasSubstr;
using testing::Simulation;

Simulation rig() { return {.table_sd_rad = to_rad(0.1), .f_sd_nT = 0.05}; }

calibration::Calibration calibrated(const Simulation& sim, std::uint64_t seed) {
  return fit::method_choice::fit(simulate(sim, 36, 121, seed), {})->calibration;
}

TEST(Diff, SameRigTwiceIsUnchanged) {
  int alarms = 0;
  double sum = 0, dof = 0;
  for (std::uint64_t run = 0; run < 30; ++run) {
    const DiffReport report = diff(calibrated(rig(), 2000 + run), calibrated(rig(), 3000 + run));
    alarms += report.changed ? 1 : 0;
    sum += report.change.chi2;
    dof += report.change.dof;
  }
  EXPECT_LE(alarms, 3);
  EXPECT_NEAR(sum / dof, 1, 4 * std::sqrt(2 / dof));
}

TEST(Diff, NamesTheParameterThatChanged) {
  Simulation later = rig();
  later.rig[1].gamma_rad += to_rad(0.01);
  later.rig[3].scale[0] *= 1 + 2e-4;
  const DiffReport report = diff(calibrated(rig(), 21), calibrated(later, 22));
  EXPECT_TRUE(report.changed);
  std::vector<std::string> named;
  for (const ParameterChange& p : report.change.named) named.push_back(p.name);
  EXPECT_THAT(named, ::testing::UnorderedElementsAre("s2 gamma", "s4 cx")) << report::conclusion_text(report);
}

TEST(Diff, TurnedArrayIsNoChange) {
  Simulation later = rig();
  later.rig = turned(later.rig, testing::passive(to_rad(-75), 2) * testing::passive(to_rad(3), 1)).sensors;
  const DiffReport report = diff(calibrated(rig(), 27), calibrated(later, 28));
  EXPECT_FALSE(report.changed) << report::conclusion_text(report);
  EXPECT_THAT(report::remarks_of(report).back(), HasSubstr("turn of the whole array"));
}

/// The turn of a sensor that is alone is that of the array on its table: nothing is told of it, and no other
/// parameter takes it over.
TEST(Diff, OneSensorTellsNothingOfItsTurn) {
  const auto alone = [](const Simulation& sim, std::uint64_t seed) {
    return fit::method_choice::fit(testing::first_sensor_of(simulate(sim, 36, 121, seed)),
                                   testing::at_the_origin())
        ->calibration;
  };
  const DiffReport same = diff(alone(rig(), 31), alone(rig(), 32));
  EXPECT_FALSE(same.changed) << report::conclusion_text(same);
  EXPECT_EQ(same.change.parameters.size(), 9U);
  for (const ParameterChange& p : same.change.parameters)
    EXPECT_LT(p.sd, p.unit == "deg" ? 0.01 : 1.0) << p.name;
  EXPECT_THAT(report::change_table(same.change, 12), HasSubstr("alpha, beta and gamma are not judged"));
  Simulation later = rig();
  later.rig[0].offset_nT[1] += 5;
  const DiffReport moved = diff(alone(rig(), 31), alone(later, 32));
  ASSERT_EQ(moved.change.named.size(), 1U) << report::conclusion_text(moved);
  EXPECT_EQ(moved.change.named.front().name, "s1 iy");
}

TEST(Diff, GaugesMayDiffer) {
  // One run with table angles and a field, the other without either.
  Simulation blind = rig();
  blind.with_angles = blind.with_f = false;
  const DiffReport same = diff(calibrated(rig(), 29), calibrated(blind, 30));
  EXPECT_FALSE(same.changed) << report::conclusion_text(same);
  blind.rig[2].offset_nT[0] += 10;
  const DiffReport moved = diff(calibrated(rig(), 29), calibrated(blind, 30));
  ASSERT_EQ(moved.change.named.size(), 1U) << report::conclusion_text(moved);
  EXPECT_EQ(moved.change.named.front().name, "s3 ix");
}

TEST(Diff, RewiredSensorIsRemarked) {
  Simulation later = rig();
  later.rig[0].mounting << -1, 0, 0, 0, 1, 0, 0, 0, 1;
  const DiffReport report = diff(calibrated(rig(), 23), calibrated(later, 24));
  EXPECT_TRUE(report.changed);
  EXPECT_THAT(report::remarks_of(report), ::testing::Contains(HasSubstr("sensor s1 stands differently")));
}

TEST(Diff, EffectsAreCompared) {
  Simulation before = rig(), later = rig();
  before.G_nT_per_m = testing::gradient_50();
  later.G_nT_per_m = 1.2 * testing::gradient_50();
  fit::FitOptions options;
  options.effects = {*effects::library::make_effect("site.gradient")};
  const auto a = fit::method_choice::fit(simulate(before, 36, 121, 25), options),
             b = fit::method_choice::fit(simulate(later, 36, 121, 26), options);
  ASSERT_TRUE(a && b);
  const DiffReport report = diff(a->calibration, b->calibration);
  EXPECT_TRUE(report.changed);
  ASSERT_FALSE(report.change.named.empty());
  for (const ParameterChange& p : report.change.named) EXPECT_THAT(p.name, HasSubstr("site.gradient"));
}

}  // namespace
}  // namespace mgtd::calib::validity
