// SPDX-License-Identifier: Apache-2.0
// The stated skew bound is true: timers that beat with the samples, digitisers of a wrong rate, a rate that
// changes. The full grid over hours is a program of its own: build/bin/clocks.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/acquire/clock_report.h"
#include "tests/unit/daemon/acquire/clock_trial.h"

namespace mgtd::daemon::acquire {
namespace {

using test::ClockGrid;
using test::run_trial;
using test::Trial;
using test::TrialResult;

constexpr double kMostViolated = 1e-3;

/// Every cell of the grid for ten minutes.
TEST(ClockBound, ItIsTrueWhateverTheTimerAndItsBeat) {
  for (const double step_s : ClockGrid::kSteps_s) {
    for (const double ppm : {0.0, 50.0}) {
      for (const double beat_s : ClockGrid::kBeats_s) {
        Trial trial = test::grid_trial(step_s, ppm, beat_s);
        trial.to_s = 300;
        const TrialResult r = run_trial(trial);
        EXPECT_LT(r.violated_share(), kMostViolated) << fmt::format(
            "step {} s, {} ppm, beat {} s: beyond by {} s", step_s, ppm, beat_s, r.worst_excess_s);
        EXPECT_LT(r.at_end_s, step_s + 0.018) << "and says something";
      }
    }
  }
}

/// The case of a turning table: after 38 s nothing has told what 4 of the 16 ms hide.
TEST(ClockBound, WhatATimerHidesIsPartOfItUntilTheBeatHasShownIt) {
  Trial trial = test::grid_trial(0.016, 50, 0);
  trial.to_s = 38;
  EXPECT_GT(run_trial(trial).at_end_s, 3e-3);
  trial.to_s = 1200;
  const TrialResult later = run_trial(trial);
  EXPECT_LT(later.at_end_s, 1.5e-3);
  EXPECT_EQ(later.violated, 0U);
}

TEST(ClockBound, ATimerInStepWithTheSamplesIsNeverTakenForNoDelay) {
  Trial trial =
      test::grid_trial(0.004, 0, 0);  // 20 ms are five steps: every sample waits as long as the last
  trial.to_s = 1200;
  const TrialResult r = run_trial(trial);
  EXPECT_EQ(r.violated, 0U);
  EXPECT_GT(r.worst_skew_s, 1e-3);
}

TEST(ClockBound, AShorterStepThatIsConfiguredNarrowsIt) {
  Trial trial = test::grid_trial(0.001, 20, 0);
  trial.config.step_s.fill(0.001);
  trial.to_s = 300;
  const TrialResult r = run_trial(trial);
  EXPECT_EQ(r.violated, 0U);
  EXPECT_LT(r.at_end_s, 1.7e-3);
}

TEST(ClockBound, AStepLongerThanConfiguredIsFoundByContradiction) {
  Trial trial = test::grid_trial(0.016, 50, 0);
  trial.config.step_s.fill(0.002);
  trial.to_s = 1200;
  const TrialResult r = run_trial(trial);
  EXPECT_LT(r.violated_share(), 0.2);
  EXPECT_GT(r.health.sensors[0].clock.step_s, 0.01);
}

/// Slow and fast, the reference and another: no frame is taken for lost, the epochs are right after seconds.
TEST(ClockBound, AWrongRateIsMeasuredAndItsEpochsAreRight) {
  for (const double percent : {-10.0, -1.0, -0.2, 0.2, 1.0, 10.0}) {
    for (const std::size_t slot : {0U, 2U}) {
      Trial trial = test::grid_trial(0.016, 20, 0);
      trial.devices.at(slot).ppm = 1e6 * (1 / (1 + percent / 100) - 1);
      trial.to_s = 120;
      const TrialResult r = run_trial(trial);
      const SensorStreamHealth& wrong = r.health.sensors.at(slot);
      EXPECT_EQ(r.violated, 0U) << percent;
      EXPECT_LT(r.flagged, 200U) << percent;
      EXPECT_EQ(wrong.lost, 0U) << percent;
      EXPECT_NEAR(wrong.clock.rate_error, percent / 100, 1e-4);
      EXPECT_LE(std::abs(wrong.clock.rate_error - percent / 100), wrong.clock.rate_error_pm + 1e-9);
      const std::string trouble = clock_report(wrong.clock, 50).trouble;
      EXPECT_NE(trouble.find(percent < 0 ? "% too low" : "% too high"), std::string::npos) << trouble;
      EXPECT_NE(trouble.find("check the digitiser's oscillator"), std::string::npos) << trouble;
      for (std::size_t i = 0; i < kSensors; ++i) {
        if (i == slot) continue;
        EXPECT_EQ(clock_report(r.health.sensors.at(i).clock, 50).trouble, "") << i;
      }
    }
  }
}

TEST(ClockBound, ARateThatChangesIsFoundWithinSecondsAndFlagged) {
  for (const double ppm : {-10'000.0, 10'000.0, 50'000.0}) {
    Trial trial = test::grid_trial(0.004, 20, 0);
    trial.devices[2].change_ppm = ppm;
    trial.devices[2].change_at_s = 100;
    trial.to_s = 400;
    const TrialResult r = run_trial(trial);
    EXPECT_LT(r.violated, 100U) << ppm;  // two seconds
    EXPECT_GT(r.flagged, 150U) << ppm;   // the start, and again
    EXPECT_NEAR(r.health.sensors[2].clock.rate_error, 1 / (1 + ppm * 1e-6) - 1, 1e-4);
  }
}

}  // namespace
}  // namespace mgtd::daemon::acquire
