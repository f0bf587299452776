// SPDX-License-Identifier: Apache-2.0
// Vehicles pass during a run: no pose that they spoiled is stored as good, and the run ends by itself.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/scenario/virtual_daemon.h"

namespace mgtd {
namespace {

using namespace mgtd::daemon;
using test::scenario_of;
using test::VirtualDaemon;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr const char* kRig = "[rig]\nname = \"table6\"\nparameters = \"table6\"\nseed = 6\n";

/// What may be left of a slow one: at r = 30 m and v = 4 m/s the field falls by 3 v / r a second, and a
/// change of 0.5 nT rms within a dwell of T = 4 s, the limit, is a mean of 0.5 nT sqrt(12) r / (3 v T).
constexpr double kLeft_nT = 1.5;

/// One every minute and a half, from far lanes to near ones, slow and fast.
std::string traffic(double from_s, double to_s) {
  std::string out;
  int i = 0;
  for (double t = from_s; t < to_s; t += 87, ++i)
    out += fmt::format("[[vehicle]]\nat_s = {}\nnearest_m = {}\nspeed_m_per_s = {}\nmoment_Am2 = 600\n", t,
                       9 + 7 * (i % 4), 4 + 5 * (i % 3));
  return out;
}

bool mentions(const std::vector<std::string>& records, std::string_view text) {
  return std::any_of(records.begin(), records.end(),
                     [&](const std::string& r) { return r.find(text) != std::string::npos; });
}

/// The largest that vehicles added to the mean of a stored pose, at any of the arms.
double worst_nT(VirtualDaemon& daemon) {
  double worst = 0;
  for (const Pose& pose : daemon.poses.poses) {
    // t_s counts from the run's start, the rig's time from when it was switched on.
    const double middle_s = static_cast<double>(pose.t_utc->ns) * 1e-9 - test::kSwitchedOn_utc_s;
    const double half_s = *pose.dwell_s / 2;
    Eigen::Vector3d sum(0, 0, 0);
    for (int k = 0; k < 50; ++k)
      sum += daemon.rig.world().vehicles_nT(middle_s - half_s + half_s * (2 * k + 1) / 50,
                                            Eigen::Vector3d::Zero());
    worst = std::max(worst, (sum / 50).norm());
  }
  return worst;
}

daemon::plan::RunPlan plan_for(VirtualDaemon& daemon) {
  return *daemon::plan::make_plan(
      {.step_deg = 20, .random = 30, .revisits = 4, .dwell_short_s = 4, .dwell_long_s = 8},
      daemon.table().limits());
}

TEST(DisturbedField, VehiclesThatPassCostTimeAndNoPoseIsSpoiled) {
  VirtualDaemon daemon(scenario_of(kRig + traffic(40, 2400)));
  ASSERT_TRUE(daemon.run(60, [&] { return daemon.all_live(); }));
  daemon.start(plan_for(daemon));
  ASSERT_TRUE(daemon.run(3600, [&] { return daemon.status && daemon.status->state == RunState::suspended; }));
  EXPECT_TRUE(is_active(daemon.status->state));
  EXPECT_FALSE(daemon.status->goes_on) << "that is of a run that is paused";
  EXPECT_NE(daemon.status->message.find("it is measured again when the field is calm"), std::string::npos);
  ASSERT_TRUE(daemon.run(3600)) << daemon.status->message;
  EXPECT_EQ(name(daemon.finished->state), "done") << daemon.finished->message;
  EXPECT_EQ(daemon.poses.poses.size(), 48U);
  EXPECT_GE(daemon.status->retries, 3);
  EXPECT_TRUE(mentions(daemon.records, "is suspended: the field changed by"));
  EXPECT_TRUE(mentions(daemon.records, "the field is calm after"));
  EXPECT_LT(worst_nT(daemon), kLeft_nT);
}

TEST(DisturbedField, TheSameTrafficSpoilsPosesWhenNobodyLooks) {
  VirtualDaemon daemon(scenario_of(kRig + traffic(40, 2400)));
  ASSERT_TRUE(daemon.run(60, [&] { return daemon.all_live(); }));
  daemon::run::RunConfig config = daemon.run_config();
  config.disturbance.limit_nT = 1e9;
  config.field_step_nT = 0;
  daemon.start(plan_for(daemon), config);
  ASSERT_TRUE(daemon.run(3600));
  // The scatter within a dwell still tells the quickest of them.
  EXPECT_GT(worst_nT(daemon), kLeft_nT) << "the test above would prove nothing";
}

/// Half-way of the move to the tenth pose of a quiet run, in the rig's time.
double on_the_way_s() {
  VirtualDaemon quiet(scenario_of(kRig));
  if (!quiet.run(60, [&] { return quiet.all_live(); })) return 0;
  quiet.start(plan_for(quiet));
  if (!quiet.run(3600)) return 0;
  const auto at_s = [&](std::size_t k, double dwells) {
    const Pose& pose = quiet.poses.poses.at(k);
    return static_cast<double>(pose.t_utc->ns) * 1e-9 - test::kSwitchedOn_utc_s + dwells * *pose.dwell_s;
  };
  return (at_s(8, 0.5) + at_s(9, -0.5)) / 2;
}

/// It comes while the table moves and is gone while it moves: the dwells between see nothing of it.
TEST(DisturbedField, AVehicleThatStandsForAWhileIsWaitedFor) {
  VirtualDaemon daemon(scenario_of(
      kRig + fmt::format("[[vehicle]]\nat_s = {:.2f}\nnearest_m = 14\nspeed_m_per_s = 40\nstands_s = 120\n"
                         "moment_Am2 = 600\n",
                         on_the_way_s())));
  ASSERT_TRUE(daemon.run(60, [&] { return daemon.all_live(); }));
  daemon.start(plan_for(daemon));
  ASSERT_TRUE(daemon.run(3600)) << daemon.status->message;
  EXPECT_EQ(name(daemon.finished->state), "done") << daemon.finished->message;
  EXPECT_TRUE(mentions(daemon.records, "the scalar reference reads"));
  EXPECT_LT(worst_nT(daemon), 1.0);
}

TEST(DisturbedField, WhatStaysPausesTheRunAndTheOperatorMayTakeItAsItIs) {
  VirtualDaemon daemon(scenario_of(std::string(kRig) +
                                   "[[vehicle]]\nat_s = 200\nnearest_m = 14\nspeed_m_per_s = 12\n"
                                   "stands_s = 1000000\nmoment_Am2 = 600\n"));
  ASSERT_TRUE(daemon.run(60, [&] { return daemon.all_live(); }));
  daemon.start(plan_for(daemon));
  ASSERT_TRUE(daemon.run(2000, [&] { return daemon.status->state == RunState::paused; }));
  EXPECT_THAT(daemon.status->message, HasSubstr("has not become so within 600 s"));
  EXPECT_THAT(daemon.status->message, HasSubstr("mgt run resume takes the field as it is"));
  daemon.tell(daemon::run::Request::resume);
  ASSERT_TRUE(daemon.run(3600));
  EXPECT_EQ(name(daemon.finished->state), "done") << daemon.finished->message;
}

/// Each car is gone for long enough that the pose is tried again, and the next comes during that dwell.
TEST(DisturbedField, WhatReturnsToOnePosePausesTheRun) {
  std::string cars;
  for (double t = 200; t < 3000; t += 13)
    cars += fmt::format("[[vehicle]]\nat_s = {}\nnearest_m = 9\nspeed_m_per_s = 25\nmoment_Am2 = 600\n", t);
  VirtualDaemon daemon(scenario_of(kRig + cars));
  ASSERT_TRUE(daemon.run(60, [&] { return daemon.all_live(); }));
  daemon.start(plan_for(daemon));
  ASSERT_TRUE(daemon.run(2000, [&] { return daemon.status->state == RunState::paused; }));
  EXPECT_THAT(daemon.status->message, HasSubstr("has not become so within 600 s"));
  EXPECT_GE(daemon.status->retries, 10) << "the same pose, again and again";
}

TEST(DisturbedField, AQuietSiteSuspendsNothing) {
  VirtualDaemon daemon(scenario_of(kRig));
  ASSERT_TRUE(daemon.run(60, [&] { return daemon.all_live(); }));
  daemon.start(plan_for(daemon));
  ASSERT_TRUE(daemon.run(3600));
  EXPECT_EQ(name(daemon.finished->state), "done") << daemon.finished->message;
  EXPECT_FALSE(mentions(daemon.records, "suspended"));
  EXPECT_EQ(daemon.status->retries, 0);
}

}  // namespace
}  // namespace mgtd
