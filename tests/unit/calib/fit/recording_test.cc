// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <set>
#include <string>

#include "calib/fit/joint/joint_fit.h"
#include "calib/report/fit_report_text.h"
#include "tests/unit/calib/fit/fitted_arrays.h"

namespace mgtd::calib {
namespace {

using testing::band;
using testing::explained;
using testing::fitted;
using ::testing::HasSubstr;
using testing::nine_squared_errors;
using ::testing::Not;

/// As of a magnetometer on a chip.
constexpr const char* kLargeNoise = "[sensors]\nnoise_nT = 20\n";

TEST(Recording, CorrelatedSamplesCountForLess) {
  constexpr double kRho = 0.9;
  double sum = 0;
  constexpr int kRuns = 12;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const PoseTable table = testing::recorded("hand", kRho, seed);
    const fit::FitReport report = fitted(table, testing::one_sensor());
    sum +=
        nine_squared_errors(report.calibration, testing::scenario_of(testing::one_sensor(), seed).truth[0]) /
        kRuns;
  }
  // A hand turns faster than white noise would need: the correlation is a bound, three times at the most.
  EXPECT_LT(sum, 9 + band(9, kRuns));
  EXPECT_GT(sum, 2);
}

/// Two thirds of the samples stand still and repeat two attitudes: they are no two thirds of what is known.
TEST(Recording, LongRestsMakeNothingSurer) {
  double sum = 0;
  constexpr int kRuns = 12;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const auto scenario = testing::scenario_of(
        testing::one_sensor(), seed,
        "[recording]\nmotion = \"hand\"\nrate_hz = 20\nduration_s = 150\nrest_s = 50\nar = 0.9\n");
    const fit::FitReport report =
        fitted(rig::pose_table_of(rig::simulated_recording(scenario)), testing::one_sensor());
    sum += nine_squared_errors(report.calibration, scenario.truth[0]) / kRuns;
  }
  EXPECT_LT(sum, 9 + band(9, kRuns));
  EXPECT_GT(sum, 2);
}

/// Its fit starts from a share of the samples, among which are gross ones.
TEST(Recording, ALongOneIsFittedWithAllItsSamples) {
  constexpr std::size_t kSamples = 12'000, kGrossEvery = 97;
  const auto scenario = testing::scenario_of(
      testing::one_sensor(), 5, "[recording]\nmotion = \"hand\"\nrate_hz = 80\nduration_s = 150\nar = 0\n");
  PoseTable table = rig::pose_table_of(rig::simulated_recording(scenario));
  ASSERT_GE(table.poses.size(), kSamples);
  std::size_t gross = 0;
  for (std::size_t k = 0; k < table.poses.size(); k += kGrossEvery, ++gross)
    table.poses[k].y_nT[0][static_cast<int>(gross % 3)] += 500;
  fit::joint::JointOptions options;
  options.geometry = testing::geometry_of(testing::one_sensor());
  const auto fit = fit::joint::fit_joint(table, options);
  ASSERT_TRUE(fit) << fit.error().text();
  EXPECT_EQ(fit->problem.poses.size(), table.poses.size());
  // Across the field 500 nT change its size by two or three only.
  EXPECT_GT(fit->outliers.size(), gross * 9 / 10);
  for (const auto& node : fit->outliers) EXPECT_EQ(node.place % kGrossEvery, 0U);
  const auto again = fit::joint::fit_joint(table, options, fit->state);
  ASSERT_TRUE(again) << again.error().text();
  const Eigen::VectorXd sd = fit->covariance.diagonal().head<sensor::kSensorParameters>().cwiseSqrt();
  const Eigen::VectorXd moved = again->state.sensors[0].parameters() - fit->state.sensors[0].parameters();
  EXPECT_LT((moved.array() / sd.array()).head<9>().abs().maxCoeff(), 0.05);
  EXPECT_LT(nine_squared_errors(fitted(table, testing::one_sensor()).calibration, scenario.truth[0]), 28);
}

/// Where a sensor is off alone, the other tells that it is; its other axes count.
TEST(Recording, OfTwoSensorsAGrossReadingIsLeftOutAlone) {
  const auto scenario = testing::scenario_of(
      testing::two_along_x(), 5, "[recording]\nmotion = \"hand\"\nrate_hz = 20\nduration_s = 150\nar = 0\n");
  const PoseTable clean = rig::pose_table_of(rig::simulated_recording(scenario));
  PoseTable table = clean;
  constexpr std::array<std::size_t, 3> kGross{200, 900, 1600};
  for (std::size_t axis = 0; axis < kGross.size(); ++axis)
    table.poses[kGross[axis]].y_nT[1][static_cast<Eigen::Index>(axis)] += 800;
  fit::joint::JointOptions options;
  options.geometry = testing::geometry_of(testing::two_along_x());
  const auto fit = fit::joint::fit_joint(table, options), without = fit::joint::fit_joint(clean, options);
  ASSERT_TRUE(fit) << fit.error().text();
  ASSERT_TRUE(without) << without.error().text();
  std::set<std::size_t> left_out;
  for (const fit::OutlierNode& node : fit->outliers) {
    left_out.insert(node.place);
    EXPECT_THAT(node.where, ::testing::StartsWith("s2"));
  }
  EXPECT_THAT(left_out, ::testing::ElementsAreArray(kGross));
  const Eigen::VectorXd sd = without->covariance.diagonal().head(24).cwiseSqrt().cwiseMax(1e-9);
  const Eigen::VectorXd moved = (fit->state.fixed() - without->state.fixed()).head(24);
  EXPECT_LT((moved.array() / sd.array()).abs().maxCoeff(), 0.2);
}

TEST(Recording, CleanOnesPass) {
  for (const double ar : {0.0, 0.9})
    EXPECT_EQ(explained(testing::recorded("hand", ar, 2), testing::one_sensor()).left,
              criticism::search::Finding::pass)
        << ar;
}

/// Readings that large noise moves are bent about the residual: no law hides in that.
TEST(Recording, CleanOnesOfLargeNoisePass) {
  for (const char* motion : {"hand", "flight"})
    EXPECT_EQ(explained(testing::recorded(motion, 0, 2, kLargeNoise), testing::one_sensor()).left,
              criticism::search::Finding::pass)
        << motion;
}

TEST(Recording, ALawInLargeNoiseIsNamed) {
  const auto found = explained(
      testing::recorded(
          "hand", 0, 2,
          std::string(kLargeNoise) + "[[effect]]\nname = \"axis.cubic\"\nwhere = \"s1.x\"\nnT_at_F0 = 100\n"),
      testing::one_sensor());
  ASSERT_EQ(found.rounds.size(), 1U);
  EXPECT_EQ(found.rounds.front().added.effect, "axis.cubic");
  EXPECT_EQ(found.left, criticism::search::Finding::pass);
}

/// Beside a disturbance of no library, steps that follow it are not named.
TEST(Recording, LawsThatOnlyDescribeAreNotNamed) {
  const auto found =
      explained(testing::recorded("hand", 0, 2,
                                  "scalar = false\n[[effect]]\nname = \"hidden.site-oscillation\"\nnT "
                                  "= [30, 20, 10]\nperiod_s = 60\n"),
                testing::one_sensor());
  EXPECT_TRUE(found.rounds.empty());
  EXPECT_EQ(found.finding, criticism::search::Finding::unknown);
}

/// Steps enough leave nothing; what they followed is no less unknown.
TEST(Recording, LawsThatDescribeEverythingDoNotMakeItPass) {
  const auto scenario = testing::scenario_of(
      testing::one_sensor(), 2,
      "[sensors]\nnoise_nT = 0.2\n[recording]\nmotion = \"flight\"\nrate_hz = 10\nduration_s = 120\n"
      "scalar = false\n[[effect]]\nname = \"hidden.site-oscillation\"\nnT = [10, -20, 15]\nperiod_s = 300\n");
  const auto found = explained(rig::pose_table_of(rig::simulated_recording(scenario)), testing::one_sensor());
  EXPECT_TRUE(found.rounds.empty());
  EXPECT_EQ(found.finding, criticism::search::Finding::unknown);
}

TEST(Recording, TheReportSaysThatNeighboursAreAlike) {
  const std::string text = report::to_text(fitted(testing::recorded("hand", 0.9, 2), testing::one_sensor()));
  EXPECT_THAT(text, HasSubstr("count as one in the uncertainties"));
  EXPECT_THAT(text, HasSubstr("no table angles: alpha = beta = gamma = 0, relative to the mounting;"));
  EXPECT_THAT(text, Not(HasSubstr("nan")));
}

TEST(Recording, WhatDoesNotExciteIsRefused) {
  for (const char* motion : {"level", "one-axis"}) {
    const auto report =
        fit::method_choice::fit(testing::recorded(motion, 0, 2), testing::options_of(testing::one_sensor()));
    EXPECT_TRUE(!report || !report->calibration.accepted_by_checks) << motion;
  }
}

}  // namespace
}  // namespace mgtd::calib
