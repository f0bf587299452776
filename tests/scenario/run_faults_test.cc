// SPDX-License-Identifier: Apache-2.0
// Cables pulled, instruments stuck and the program killed in the middle of a run, through the real drivers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenario/clean_poses.h"
#include "tests/scenario/virtual_daemon.h"
#include "tests/support/parameter_name.h"

namespace mgtd {
namespace {

using namespace mgtd::daemon;
using test::expect_clean;
using test::scenario_of;
using test::VirtualDaemon;
using ::testing::HasSubstr;

constexpr int kPoses = 30;

rig::Scenario table6() {
  return scenario_of("[rig]\nname = \"table6\"\nparameters = \"table6\"\nseed = 6\n");
}

daemon::plan::RunPlan plan_of(VirtualDaemon& daemon) {
  return *daemon::plan::make_plan(
      {.step_deg = 20, .random = 12, .revisits = 2, .dwell_short_s = 2, .dwell_long_s = 3},
      daemon.table().limits());
}

/// Started and some poses far.
void start(VirtualDaemon& daemon, std::size_t poses) {
  ASSERT_TRUE(daemon.run(60, [&] { return daemon.all_live(); }));
  daemon.start(plan_of(daemon));
  ASSERT_TRUE(daemon.run(600, [&] { return daemon.poses.poses.size() >= poses; }));
  ASSERT_FALSE(daemon.finished) << daemon.finished->message;
}

bool run_to(VirtualDaemon& daemon, RunState state, double limit_s = 200) {
  return daemon.run(limit_s, [&] { return daemon.status->state == state; });
}

class TroubleThatPasses : public ::testing::TestWithParam<const char*> {};

TEST_P(TroubleThatPasses, CostsTimeButNeitherThePlanNorTheData) {
  // Struck in each part of a pose's life.
  for (const RunState state : {RunState::moving, RunState::settling, RunState::dwelling}) {
    SCOPED_TRACE(name(state));
    VirtualDaemon daemon(table6());
    start(daemon, 3);
    ASSERT_TRUE(run_to(daemon, state));
    daemon.fault(GetParam());
    daemon.run(3600, [&] {
      return daemon.status->state == RunState::paused && daemon.rig.plugged(4) && daemon.all_live();
    });
    for (int i = 0; i < 5 && !daemon.finished; ++i) {  // an operator who looks and goes on
      daemon.run(60);
      daemon.tell(daemon::run::Request::resume);
      daemon.run(1200);
    }
    const std::string fault = GetParam();
    if (fault.starts_with("unplug")) {
      EXPECT_THAT(daemon.notes, ::testing::Not(::testing::IsEmpty()));
    }
    // One that repeats itself before the dwell begins is waited for.
    if (fault.find("fluxgate") != std::string::npos && !fault.starts_with("freeze")) {
      EXPECT_GT(daemon.gaps + static_cast<unsigned>(daemon.status->retries), 1u);
    }
    ASSERT_TRUE(daemon.finished) << daemon.status->message;
    EXPECT_EQ(name(daemon.finished->state), "done") << daemon.finished->message;
    ASSERT_EQ(daemon.poses.poses.size(), static_cast<std::size_t>(kPoses));
    expect_clean(daemon);
  }
}

INSTANTIATE_TEST_SUITE_P(Faults, TroubleThatPasses,
                         ::testing::Values("unplug fluxgate1 for 3", "unplug fluxgate3 for 20",
                                           "stall fluxgate2 for 4", "freeze fluxgate4 for 6",
                                           "garbage fluxgate1", "torn fluxgate2 for 10",
                                           "unplug scalar for 15", "stall scalar for 15",
                                           "unplug table for 5", "stall table for 5", "freeze table for 8",
                                           "garbage table"),
                         [](const auto& info) { return mgtd::testing::parameter_name(info.param); });

/// Faults, one a second after the other.
class TroubleThatNeedsNobody : public ::testing::TestWithParam<std::vector<const char*>> {};

TEST_P(TroubleThatNeedsNobody, TheRunGoesOnByItself) {
  for (const RunState state : {RunState::moving, RunState::settling, RunState::dwelling}) {
    for (const double later_s : {0.0, 0.4, 1.1}) {
      SCOPED_TRACE(fmt::format("{} {}", name(state), later_s));
      VirtualDaemon daemon(table6());
      start(daemon, 3);
      ASSERT_TRUE(run_to(daemon, state));
      daemon.run(later_s);
      for (const char* fault : GetParam()) {
        daemon.fault(fault);
        daemon.run(1);
      }
      ASSERT_TRUE(daemon.run(
          3600, [&] { return daemon.status->state == RunState::paused && !daemon.status->goes_on; }));
      ASSERT_TRUE(daemon.finished) << daemon.status->message;
      EXPECT_EQ(name(daemon.finished->state), "done") << daemon.finished->message;
      ASSERT_EQ(daemon.poses.poses.size(), static_cast<std::size_t>(kPoses));
      expect_clean(daemon);
    }
  }
}

using Faults = std::vector<const char*>;
INSTANTIATE_TEST_SUITE_P(Faults, TroubleThatNeedsNobody,
                         ::testing::Values(Faults{"late table for 60"},
                                           Faults{"late table for 60", "unplug fluxgate2 for 3"},
                                           Faults{"late table for 2", "stall fluxgate1 for 3"},
                                           Faults{"mute table for 5"}, Faults{"mute table for 15"},
                                           Faults{"stall table for 15"}, Faults{"unplug table for 5"}),
                         [](const auto& info) {
                           return mgtd::testing::parameter_name(
                               fmt::format("{}", fmt::join(info.param, " then ")));
                         });

TEST(RunFaults, ATableWhoseCableIsPulledMayStillMove) {
  for (const char* fault : {"unplug table for 5", "mute table for 20", "stall table for 20"}) {
    VirtualDaemon daemon(table6());
    start(daemon, 3);
    ASSERT_TRUE(run_to(daemon, RunState::moving));
    daemon.run(0.5);
    daemon.fault(fault);
    ASSERT_TRUE(run_to(daemon, RunState::paused));
    EXPECT_THAT(daemon.status->message, HasSubstr("the table cannot be reached and may still move"));
    EXPECT_THAT(daemon.status->message, ::testing::Not(HasSubstr("stopped")));
    ASSERT_TRUE(daemon.run(3600)) << daemon.status->message;
    EXPECT_EQ(name(daemon.finished->state), "done") << daemon.finished->message;
  }
}

TEST(RunFaults, AnotherDeviceOnThePortIsNamedInTheStatusOfTheRun) {
  for (const char* port : {"fluxgate2", "table", "scalar"}) {
    SCOPED_TRACE(port);
    VirtualDaemon daemon(table6());
    start(daemon, 3);
    ASSERT_TRUE(run_to(daemon, RunState::dwelling));
    daemon.fault(fmt::format("stranger {} for 40", port));
    ASSERT_TRUE(daemon.run(40, [&] {
      return daemon.status->message.find("wrong device on the port") != std::string::npos;
    })) << daemon.status->message;
    ASSERT_TRUE(daemon.run(3600)) << daemon.status->message;
    EXPECT_EQ(name(daemon.finished->state), "done") << daemon.finished->message;
  }
}

TEST(RunFaults, ATimeStamperThatIsNotThereIsNamed) {
  VirtualDaemon daemon(scenario_of("[rig]\nparameters = \"table6\"\n[sensors]\npalmacq = false\n"),
                       {"palmacq = false", "palmacq = true"});
  EXPECT_FALSE(daemon.run(30, [&] { return daemon.shown(0).state == LinkState::live; }));
  for (std::size_t port = 0; port < kSensors; ++port)
    EXPECT_THAT(daemon.shown(port).detail, HasSubstr("no time-stamper answers: set palmacq = false?"));
}

TEST(RunFaults, JammedTableEndsInAPauseThatNamesTheTable) {
  VirtualDaemon daemon(table6());
  start(daemon, 2);
  ASSERT_TRUE(run_to(daemon, RunState::moving));
  daemon.fault("freeze table");
  ASSERT_TRUE(run_to(daemon, RunState::paused, 1200));
  EXPECT_THAT(daemon.status->message, HasSubstr("table"));
  daemon.tell(daemon::run::Request::abort);
  ASSERT_TRUE(daemon.run(60));
  EXPECT_EQ(daemon.finished->state, RunState::aborted);
}

TEST(RunFaults, SensorThatStaysAwayFailsTheRunAndKeepsThePoses) {
  VirtualDaemon daemon(table6());
  start(daemon, 5);
  daemon.fault("unplug fluxgate2");
  ASSERT_TRUE(daemon.run(600));
  EXPECT_EQ(daemon.finished->state, RunState::failed);
  EXPECT_THAT(daemon.finished->message, HasSubstr("s2"));
  EXPECT_THAT(daemon.finished->message, HasSubstr("are kept"));
}

TEST(RunFaults, AbortInMotionLeavesTheTableStandingStill) {
  VirtualDaemon daemon(table6());
  start(daemon, 1);
  ASSERT_TRUE(run_to(daemon, RunState::moving));
  daemon.run(0.5);
  daemon.tell(daemon::run::Request::abort);
  ASSERT_TRUE(daemon.run(60));
  EXPECT_EQ(daemon.finished->state, RunState::aborted);
  for (const auto axis : {rig::azimuth, rig::pitch, rig::roll})
    EXPECT_FALSE(daemon.rig.world().axis(axis).moving(daemon.t_s));
}

TEST(RunFaults, KilledAnywhereTheRunGoesOnAtTheNextPose) {
  for (const double after_s : {0.3, 2.0, 4.0, 6.0, 8.0, 11.0}) {  // parts of a pose's life
    SCOPED_TRACE(after_s);
    VirtualDaemon daemon(table6());
    start(daemon, 4);
    daemon.run(after_s);
    const std::size_t kept = daemon.poses.poses.size();
    daemon::run::EarlierLife earlier{daemon.started_utc(), {}, 0};
    for (const Pose& pose : daemon.poses.poses) {
      earlier.stored.insert(pose.number);
      earlier.last_t_s = *pose.t_s;
    }
    daemon.restart();  // finds its instruments streaming and the table on its way
    daemon.run(30);
    ASSERT_TRUE(daemon.all_live());
    daemon.start(plan_of(daemon), std::nullopt, earlier);
    ASSERT_TRUE(daemon.run(3600)) << daemon.status->message;
    EXPECT_EQ(name(daemon.finished->state), "done") << daemon.finished->message;
    ASSERT_EQ(daemon.poses.poses.size(), static_cast<std::size_t>(kPoses));
    EXPECT_EQ(daemon.poses.poses[kept].number, static_cast<int>(kept) + 1);
    for (std::size_t i = 1; i < daemon.poses.poses.size(); ++i) {
      EXPECT_GT(*daemon.poses.poses[i].t_s, *daemon.poses.poses[i - 1].t_s);
      EXPECT_NEAR(
          *daemon.poses.poses[i].t_s - *daemon.poses.poses[i - 1].t_s,
          static_cast<double>(daemon.poses.poses[i].t_utc->ns - daemon.poses.poses[i - 1].t_utc->ns) * 1e-9,
          1e-3);
    }
    expect_clean(daemon);
  }
}

}  // namespace
}  // namespace mgtd
