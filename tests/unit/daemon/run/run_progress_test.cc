// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/run_progress.h"

#include <gtest/gtest.h>

#include "proto/units.h"

namespace mgtd::daemon::run {
namespace {

Instant at(double t_s) { return Instant{from_seconds(t_s)}; }

/// Ten poses 10 degrees apart, 4 s each; at 10 deg/s 1 s of travel, 1 s of commands, 2 s of settling.
plan::RunPlan ten() {
  plan::RunPlan plan;
  for (int i = 1; i <= 10; ++i) plan.poses.push_back({i, "random", {to_rad(10.0 * i), 0, 0}, 4, 0, {}});
  return plan;
}
constexpr plan::Pace kPace{.velocity_rad_per_s = 10 * kRadiansPerDegree, .solve_s = 1};

TEST(RunProgress, StartsFromThePlan) {
  const RunProgress progress(ten(), kPace);
  EXPECT_NEAR(progress.remaining_s(at(0)), 10 * 8 + 1, 1e-9);
  EXPECT_EQ(progress.done(), 0u);
  EXPECT_EQ(progress.next(), 0u);
}

TEST(RunProgress, LearnsHowLongMovesAndSettlingReallyTake) {
  RunProgress progress(ten(), kPace);
  for (std::size_t i = 0; i < 9; ++i) {
    progress.begin(i, at(100));
    progress.finish(i, at(100 + 4 + 12));  // 12 s beside the dwell, three times what was foreseen
  }
  // (3 prior poses x 4 s + 9 x 12 s) / (12 x 4 s) = 2.5
  EXPECT_NEAR(progress.remaining_s(at(200)), 4 + 2.5 * 4 + 1, 1e-9);
}

TEST(RunProgress, CountsDownWithinAPoseButNotBelowZero) {
  RunProgress progress(ten(), kPace);
  progress.begin(0, at(0));
  EXPECT_NEAR(progress.remaining_s(at(3)), 10 * 8 - 3 + 1, 1e-9);
  EXPECT_NEAR(progress.remaining_s(at(300)), 9 * 8 + 1, 1e-9);
}

TEST(RunProgress, PauseDoesNotCount) {
  RunProgress progress(ten(), kPace);
  progress.begin(0, at(0));
  progress.begin(0, at(1000));
  progress.finish(0, at(1008));
  EXPECT_NEAR(progress.remaining_s(at(1008)), 9 * 8 + 1, 1e-9);
}

TEST(RunProgress, PosesOfAnEarlierLifeAreDone) {
  RunProgress progress(ten(), kPace);
  progress.set_done(0);
  progress.set_done(1);
  EXPECT_EQ(progress.done(), 2u);
  EXPECT_EQ(progress.next(), 2u);
  for (std::size_t i = 2; i < 10; ++i) progress.set_done(i);
  EXPECT_EQ(progress.next(), std::nullopt);
  EXPECT_NEAR(progress.remaining_s(at(0)), 1, 1e-9);
}

}  // namespace
}  // namespace mgtd::daemon::run
