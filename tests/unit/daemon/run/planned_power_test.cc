// SPDX-License-Identifier: Apache-2.0
// What the default run is good for, against runs with simpler habits at the same attitudes.
//
//   run                                  effects seen   pairs told apart
//   default: both senses, two dwells          29           395 of 406
//   azimuth always from below                 28           367 of 378   (no backlash)
//   senses and stops not recorded             27           340 of 351   (no backlash, no settling)
//
// Coming from both sides takes 2 of the 60 minutes.
#include <gtest/gtest.h>

#include <algorithm>

#include "calib/design/experiment_design.h"
#include "daemon/run/planned_poses.h"

namespace mgtd::daemon::run {
namespace {

struct Power {
  calib::design::DesignPower all;
  [[nodiscard]] int told_apart() const { return all.pairs - static_cast<int>(all.inseparable.size()); }
  [[nodiscard]] double smallest(const std::string& effect) const {
    for (const auto& d : all.detectable)
      if (d.effect == effect) return d.value;
    return 0;
  }
  [[nodiscard]] bool sees(const std::string& effect) const { return smallest(effect) > 0; }
  [[nodiscard]] const calib::design::LookAlike* confuses(const std::string& a, const std::string& b) const {
    for (const auto& pair : all.inseparable)
      if ((pair.effect == a && pair.alternative == b) || (pair.effect == b && pair.alternative == a))
        return &pair;
    return nullptr;
  }
};

Power power_of(const PoseTable& poses) {
  calib::design::DesignRequest request;
  request.poses = poses;
  auto planned = calib::design::evaluate_design(request);
  EXPECT_TRUE(planned) << planned.error().text();
  return planned ? Power{*planned->power} : Power{};
}

PoseTable default_run() {
  auto poses = planned_poses(config::Config{});
  EXPECT_TRUE(poses) << poses.error().text();
  return poses ? *poses : PoseTable{};
}

TEST(PlannedPower, TheDefaultRunSeparatesWhatItsOwnPosesCan) {
  const Power power = power_of(default_run());
  EXPECT_EQ(power.all.pairs, 406);
  EXPECT_EQ(power.told_apart(), 395);
  for (const char* const memory : {"axis.hysteresis", "axis.settling", "table.backlash"}) {
    EXPECT_TRUE(power.sees(memory)) << memory;
    for (const auto& pair : power.all.inseparable)
      EXPECT_TRUE(pair.effect != memory && pair.alternative != memory)
          << pair.effect << " - " << pair.alternative;
  }
}

TEST(PlannedPower, OneFieldStrengthNeverTellsAnAxisOwnSquareFromThoseOfTheOthers) {
  const Power power = power_of(default_run());
  const auto* const pair = power.confuses("axis.quadratic", "axis.transverse");
  ASSERT_NE(pair, nullptr);
  EXPECT_GT(pair->correlation, 0.999);
  ASSERT_TRUE(pair->remedy);
  EXPECT_NE(pair->remedy->action.find("field a fifth weaker"), std::string::npos) << pair->remedy->action;
  EXPECT_GT(pair->remedy->p_right, calib::design::kSeparated);
}

TEST(PlannedPower, ARoomThatJustWarmsUpAsksForAHeatPulse) {
  const Power power = power_of(default_run());
  const auto* const pair = power.confuses("axis.gain.drift", "axis.gain.temperature2");
  ASSERT_NE(pair, nullptr);
  ASSERT_TRUE(pair->remedy);
  EXPECT_NE(pair->remedy->action.find("heat pulse"), std::string::npos) << pair->remedy->action;
  EXPECT_GT(pair->remedy->minutes, 10);
}

TEST(PlannedPower, OneSidedApproachHidesTheBacklash) {
  PoseTable poses = default_run();
  for (Pose& pose : poses.poses) pose.sense = 1;
  const Power one = power_of(poses), both = power_of(default_run());
  // From one side the backlash is a turn of all arms about the vertical, which only the prior of that holds.
  EXPECT_TRUE(both.sees("table.backlash"));
  EXPECT_LT(both.smallest("table.backlash"), 0.1);
  EXPECT_FALSE(one.sees("table.backlash")) << one.smallest("table.backlash");
  EXPECT_EQ(one.told_apart(), 367);
}

TEST(PlannedPower, WhatIsNotRecordedCannotBeTested) {
  PoseTable poses = default_run();
  for (Pose& pose : poses.poses) pose.sense = std::nullopt, pose.since_stop_s = std::nullopt;
  const Power power = power_of(poses);
  EXPECT_EQ(power.all.pairs, 351);
  EXPECT_EQ(power.told_apart(), 340);
  EXPECT_FALSE(power.sees("axis.settling"));
  const bool says_why =
      std::any_of(power.all.untestable.begin(), power.all.untestable.end(), [](const auto& u) {
        return u.effect == "axis.settling" && u.why.find("since_stop_s") != std::string::npos;
      });
  EXPECT_TRUE(says_why);
}

}  // namespace
}  // namespace mgtd::daemon::run
