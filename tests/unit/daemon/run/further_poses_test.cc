// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/further_poses.h"

#include <gmock/gmock.h>

#include "tests/unit/daemon/run/run_bench.h"

namespace mgtd::test {
namespace {

using ::testing::HasSubstr;

daemon::run::NextPoses two(double pitch_deg) {
  daemon::run::NextPoses out{{.poses = 3, .found = "AMBIGUOUS: a or b", .next = "two more", .minutes = 5},
                             {}};
  for (int i = 1; i <= 2; ++i)
    out.poses.push_back({.number = i, .angles = {to_rad(10.0 * i), to_rad(pitch_deg), 0}});
  out.poses.front().note = "warm it";
  return out;
}

TEST(FurtherPoses, StandBehindThePlanWithNumbersOfTheirOwn) {
  const auto further = daemon::run::further_poses(two(20), bench_plan(3), bench_limits());
  ASSERT_EQ(further.poses.size(), 2U);
  EXPECT_EQ(further.poses[0].number, 4);
  EXPECT_EQ(further.poses[1].number, 5);
  EXPECT_EQ(further.poses[0].note, "warm it");
  EXPECT_EQ(further.judgement.minutes, 5);
}

TEST(FurtherPoses, WhatTheTableCannotTakeIsNotMeasured) {
  const auto further = daemon::run::further_poses(two(120), bench_plan(3), bench_limits());
  EXPECT_TRUE(further.poses.empty());
  EXPECT_EQ(further.judgement.minutes, 0);
  EXPECT_THAT(further.judgement.next, HasSubstr("not on this table"));
  EXPECT_THAT(further.judgement.next, HasSubstr("pitch_deg"));
}

TEST(FurtherPoses, ARunThatCannotBeJudgedSaysWhy) {
  const auto further = daemon::run::further_poses(fail(ErrorCode::refused, "too few poses", "measure more"),
                                                  bench_plan(3), bench_limits());
  EXPECT_TRUE(further.poses.empty());
  EXPECT_EQ(further.judgement.found, "the run could not be judged");
  EXPECT_THAT(further.judgement.next, HasSubstr("too few poses"));
}

TEST(FurtherPoses, MinutesAndLooksAreSpent) {
  const auto left = daemon::run::left_after({{.poses = 157, .found = "", .next = "", .minutes = 12}}, 30);
  EXPECT_EQ(left.minutes, 18);
  EXPECT_EQ(left.looks, daemon::run::kMostJudgements - 2);
}

}  // namespace
}  // namespace mgtd::test
