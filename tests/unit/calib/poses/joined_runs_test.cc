// SPDX-License-Identifier: Apache-2.0
#include "calib/poses/joined_runs.h"

#include <gtest/gtest.h>

#include <set>

#include "calib/poses/run_time.h"

namespace mgtd::calib::testing {
namespace {

constexpr std::int64_t kNoon_ns = 1'795'000'000'000'000'000, kSecond_ns = 1'000'000'000;

/// Three poses a minute apart, the first `at_s` after noon; t_s counts from ten seconds before it.
PoseTable run_at(std::int64_t at_s, const std::string& source) {
  PoseTable out;
  out.source = source;
  for (int k = 0; k < 3; ++k) {
    Pose pose;
    pose.number = k + 1;
    pose.t_s = 10 + 60 * k;
    pose.t_utc = WallTime{kNoon_ns + (at_s + 60 * k) * kSecond_ns};
    pose.f_nT = static_cast<double>(at_s) + k;
    out.poses.push_back(pose);
    out.path.push_back({.t_s = *pose.t_s - 5, .angles = {}});
  }
  return out;
}

PoseTable without_utc(PoseTable table, double later_s) {
  for (Pose& pose : table.poses) {
    pose.t_utc.reset();
    *pose.t_s += later_s;
  }
  return table;
}

PoseTable timeless(PoseTable table) {
  for (Pose& pose : table.poses) pose.t_s.reset(), pose.t_utc.reset();
  return table;
}

TEST(JoinedRuns, TheLaterRunGoesOnInTimeAndNumber) {
  const PoseTable a = run_at(0, "a"), b = run_at(3600, "b");
  const auto both = poses::joined(a, b);
  ASSERT_TRUE(both) << both.error().text();
  ASSERT_EQ(both->poses.size(), 6U);
  std::set<int> numbers;
  for (const Pose& pose : both->poses) {
    numbers.insert(pose.number);
    EXPECT_DOUBLE_EQ(poses::RunTime::of(*both).hours(pose), *pose.t_s / 3600)
        << "t_s and t_utc tell the same";
  }
  EXPECT_EQ(numbers, (std::set<int>{1, 2, 3, 4, 5, 6}));
  EXPECT_DOUBLE_EQ(*both->poses[3].t_s, 3610);
  EXPECT_DOUBLE_EQ(both->path[3].t_s, 3605);
  EXPECT_EQ(both->source, "a and b");
}

TEST(JoinedRuns, WhichCameFirstTellsTheClockAndNotTheOrderOfTheWords) {
  const auto both = poses::joined(run_at(3600, "late"), run_at(0, "early"));
  ASSERT_TRUE(both);
  EXPECT_EQ(*both->poses.front().f_nT, 0);
  EXPECT_EQ(*both->poses.back().f_nT, 3602);
  EXPECT_EQ(both->source, "early and late");
}

TEST(JoinedRuns, WithoutAbsoluteTimeTheSecondMustGoOn) {
  const PoseTable a = without_utc(run_at(0, "a"), 0);
  EXPECT_TRUE(poses::joined(a, without_utc(run_at(0, "b"), 600)));
  const auto again = poses::joined(a, a);
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().message.find("overlap"), std::string::npos);
  EXPECT_FALSE(again.error().remedy.empty());
}

TEST(JoinedRuns, TheSameRunTwiceIsRefused) { EXPECT_FALSE(poses::joined(run_at(0, "a"), run_at(0, "a"))); }

TEST(JoinedRuns, RunsWithoutAnyTimeStandAsGiven) {
  const auto both = poses::joined(timeless(run_at(0, "a")), timeless(run_at(3600, "b")));
  ASSERT_TRUE(both);
  EXPECT_EQ(*both->poses.front().f_nT, 0);
}

TEST(JoinedRuns, OneThatTellsItsTimeAndOneThatDoesNotAreRefused) {
  EXPECT_FALSE(poses::joined(run_at(0, "a"), timeless(run_at(3600, "b"))));
  EXPECT_FALSE(poses::joined(run_at(0, "a"), without_utc(run_at(0, "b"), 900)));
}

TEST(JoinedRuns, ARunWithoutPosesIsRefused) { EXPECT_FALSE(poses::joined(run_at(0, "a"), PoseTable{})); }

}  // namespace
}  // namespace mgtd::calib::testing
