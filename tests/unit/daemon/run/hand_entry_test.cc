// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/hand_entry.h"

#include <gmock/gmock.h>

#include "tests/unit/daemon/run/run_bench.h"

namespace mgtd::daemon::run {
namespace {

using ::testing::HasSubstr;

plan::RunPlan plan() { return test::bench_plan(3); }

TEST(HandEntry, AsksForNothingOnATableWithMotors) {
  HandEntry hands(false, plan(), {});
  EXPECT_FALSE(hands.used());
  EXPECT_TRUE(hands.way_known());
  EXPECT_FALSE(hands.ask_before(plan().poses[0]));
}

TEST(HandEntry, AFarEntryIsAskedForAgainAndStandsTheSecondTime) {
  HandEntry hands(true, plan(), {});
  const plan::PlannedPose pose = plan().poses[0];
  ASSERT_TRUE(hands.ask_before(pose));
  const TableAngles wrong{to_rad(140), 0, 0};  // 40 deg are asked for
  EXPECT_FALSE(hands.enter(wrong, pose));
  EXPECT_THAT(hands.question(), HasSubstr("azimuth 140 deg was entered where 40 was asked for"));
  EXPECT_TRUE(hands.enter(wrong, pose));
  EXPECT_EQ(hands.scales().azimuth_rad, wrong.azimuth_rad);
  EXPECT_FALSE(hands.ask_before(pose)) << "it was entered";
  EXPECT_TRUE(hands.ask_before(plan().poses[1]));
}

TEST(HandEntry, APauseForgetsTheScalesAndRedoKeepsThePoseBefore) {
  HandEntry hands(true, plan(), {});
  const plan::PlannedPose pose = plan().poses[1];
  ASSERT_TRUE(hands.ask_before(pose));
  ASSERT_TRUE(hands.enter(pose.target, pose));
  hands.paused();
  EXPECT_TRUE(hands.entered()) << "redo can ask for it";
  EXPECT_FALSE(hands.forget(pose).last_pose) << "the entry under way is the last one";
  EXPECT_FALSE(hands.entered());
  EXPECT_TRUE(hands.forget(pose).last_pose);
}

TEST(HandEntry, AMountingTurnsThePlatform) {
  plan::RunPlan mounted = plan();
  for (plan::PlannedPose& pose : mounted.poses) pose.mount = 1;
  HandEntry hands(false, mounted, {});
  EXPECT_TRUE(hands.used());
  EXPECT_FALSE(hands.way_known()) << "nobody has said how the array is mounted";
  ASSERT_TRUE(hands.ask_before(mounted.poses[0]));
  EXPECT_EQ(hands.prompt()->what, OperatorPrompt::What::mount);
  ASSERT_TRUE(hands.enter({0, to_rad(5), 0}, mounted.poses[0]));
  EXPECT_NEAR(hands.platform({0, 0, 0}).pitch_rad, to_rad(5), 1e-12);
  EXPECT_EQ(hands.forget(mounted.poses[0]).mount, 1);
  EXPECT_NEAR(hands.platform({0, 0, 0}).pitch_rad, 0, 1e-12);
}

}  // namespace
}  // namespace mgtd::daemon::run
