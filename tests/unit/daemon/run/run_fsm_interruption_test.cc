// SPDX-License-Identifier: Apache-2.0
// A run interrupted at every step of its life, in every way. What it promises is checked by the bench at each
// action; here, that it always ends or waits as it should.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/run/run_fsm.h"
#include "tests/unit/daemon/run/run_bench.h"

namespace mgtd::daemon::run {
namespace {

using test::bench_config;
using test::bench_plan;
using test::RunBench;
using ::testing::HasSubstr;

/// Three poses, one of them approached by way of another point.
plan::RunPlan short_plan() {
  auto plan = bench_plan(3);
  plan.poses[1].target.azimuth_rad = to_rad(20);
  return plan;
}

RunConfig quick_config() {
  auto config = bench_config();
  config.preflight.length_s = 3;
  config.wait.lost_max_s = 20;
  return config;
}

/// Ticks that an undisturbed run takes.
int life() {
  static const int ticks = [] {
    RunBench bench(short_plan(), quick_config());
    int n = 0;
    for (; !bench.finished && n < 100'000; ++n) bench.tick();
    EXPECT_EQ(bench.finished->state, RunState::done);
    return n;
  }();
  return ticks;
}

/// Runs `ticks` and then lets the test interrupt.
template <class Interrupt>
void at_every_step(Interrupt interrupt) {
  std::set<RunState> seen;
  for (int n = 0; n < life(); ++n) {
    SCOPED_TRACE(n);
    RunBench bench(short_plan(), quick_config());
    for (int i = 0; i < n; ++i) bench.tick();
    if (bench.status) seen.insert(bench.status->state);
    interrupt(bench);
    if (::testing::Test::HasFailure()) return;
  }
  for (const RunState state : {RunState::preflight, RunState::homing, RunState::moving, RunState::settling,
                               RunState::dwelling, RunState::solving}) {
    EXPECT_TRUE(seen.contains(state)) << name(state) << " was never interrupted";
  }
}

TEST(RunFsmInterruption, AbortReachesAbortedFromEveryStep) {
  at_every_step([](RunBench& bench) {
    const int stops = bench.stops;
    bench.send(Request::abort);
    EXPECT_GT(bench.stops, stops);
    EXPECT_FALSE(bench.table.moving);
    bench.send(Request::abort);  // idempotent
    bench.run(20);
    ASSERT_TRUE(bench.finished);
    EXPECT_EQ(bench.finished->state, RunState::aborted);
    EXPECT_EQ(bench.status->proposed, "");
    EXPECT_TRUE(bench.fsm.step(Request::abort, bench.now()).empty());
  });
}

TEST(RunFsmInterruption, AbortWorksWhilePausedAndWhileADeviceIsAway) {
  at_every_step([](RunBench& bench) {
    bench.send(Request::pause);
    bench.lose(Slot::table());
    bench.run(0.3);
    if (bench.finished) return;  // the fit was done and needs no table
    bench.send(Request::abort);
    bench.run(20);
    ASSERT_TRUE(bench.finished);
    EXPECT_EQ(bench.finished->state, RunState::aborted);
    EXPECT_THAT(bench.finished->message, HasSubstr("look at it"));
  });
}

TEST(RunFsmInterruption, PauseStopsTheTableAndResumeRepeatsThePose) {
  at_every_step([](RunBench& bench) {
    const bool possible = bench.fsm.possible(Request::pause).has_value();
    EXPECT_EQ(possible, bench.solves == 0);
    bench.send(Request::pause);
    EXPECT_FALSE(possible && bench.table.moving);
    const auto moves = bench.moves.size();
    bench.run(30);
    if (possible) {
      EXPECT_EQ(bench.status->state, RunState::paused);
      EXPECT_EQ(bench.moves.size(), moves);
    }
    bench.send(Request::resume);
    bench.run(300);
    ASSERT_TRUE(bench.finished);
    EXPECT_EQ(bench.finished->state, RunState::done) << bench.finished->message;
    EXPECT_EQ(bench.stored.size(), 3u);
  });
}

TEST(RunFsmInterruption, DeviceThatComesBackCostsOnePose) {
  for (const Slot slot : {Slot::sensor(2), Slot::table(), Slot::scalar()}) {
    SCOPED_TRACE(slot.name());
    at_every_step([&](RunBench& bench) {
      const bool measuring = bench.solves == 0;
      const bool preflight = !bench.status || bench.status->state == RunState::preflight;
      bench.lose(slot);
      if (slot == Slot::table()) {
        bench.table.stop();  // its driver's port closed: the controller was stopped on reopening
        bench.table.referenced = false;
      }
      EXPECT_FALSE(bench.table.moving);
      if (measuring && !preflight) {
        EXPECT_EQ(bench.status->state, RunState::paused);
      }
      bench.run(1.5);
      bench.give_back(slot);
      bench.run(400);
      ASSERT_TRUE(bench.finished);
      if (!preflight || bench.finished->state == RunState::done) {
        EXPECT_EQ(bench.finished->state, RunState::done) << bench.finished->message;
        EXPECT_EQ(bench.stored.size(), 3u);
      } else {
        EXPECT_EQ(bench.finished->state, RunState::failed);  // the preflight saw it
        EXPECT_TRUE(bench.moves.empty());
      }
    });
  }
}

/// Under way to the first pose.
void move(RunBench& bench) {
  for (int i = 0; i < 10'000 && !(bench.status && bench.status->state == RunState::moving); ++i) bench.tick();
  ASSERT_EQ(bench.status->state, RunState::moving);
}

TEST(RunFsmInterruption, ATableThatIsLostIsNotSaidToBeStopped) {
  const std::string unreachable = "the table cannot be reached and may still move";
  RunBench bench(short_plan(), quick_config());
  move(bench);
  bench.lose(Slot::sensor(1));
  EXPECT_THAT(bench.status->message, HasSubstr("s2 is lost ("));
  EXPECT_THAT(bench.status->message, HasSubstr("; the table is stopped, waiting up to 20 s"));
  bench.lose(Slot::table());
  EXPECT_THAT(bench.status->message, HasSubstr("; " + unreachable + ", waiting up to 20 s"));
  EXPECT_THAT(bench.status->message, HasSubstr("s2 is lost ("));
  bench.send(Request::pause);
  EXPECT_THAT(bench.status->message, HasSubstr("paused by the operator"));
  EXPECT_THAT(bench.status->message, HasSubstr(unreachable));
  EXPECT_EQ(bench.fsm.possible(Request::resume).error().code, ErrorCode::state);
  bench.give_back(Slot::table());
  EXPECT_THAT(bench.status->message, ::testing::Not(HasSubstr(unreachable)));
}

TEST(RunFsmInterruption, ATableThatStaysAwayMayStillMoveWhenTheRunHasFailed) {
  RunBench bench(short_plan(), quick_config());
  move(bench);
  bench.lose(Slot::table());
  bench.run(40);
  ASSERT_TRUE(bench.finished);
  EXPECT_THAT(bench.finished->message, HasSubstr("the table cannot be reached and may still move"));
}

TEST(RunFsmInterruption, WhileItWaitsTheRunSaysWhatTheLinkSays) {
  RunBench bench(short_plan(), quick_config());
  move(bench);
  bench.lose(Slot::sensor(1));
  LinkHealth link;
  link.state = LinkState::failed;
  link.detail = "wrong device on the port: its serial number is 7, not 8";
  bench.send(LinkSeen{Slot::sensor(1), link});
  EXPECT_THAT(bench.status->message,
              HasSubstr("s2 is lost (wrong device on the port: its serial number is 7"));
}

TEST(RunFsmInterruption, DeviceThatStaysAwayFailsTheRunInLimitedTime) {
  for (const Slot slot : {Slot::sensor(0), Slot::table(), Slot::scalar()}) {
    SCOPED_TRACE(slot.name());
    at_every_step([&](RunBench& bench) {
      const bool measuring = bench.solves == 0;
      bench.lose(slot);
      bench.run(40);
      ASSERT_TRUE(bench.finished);
      EXPECT_EQ(bench.finished->state, measuring ? RunState::failed : RunState::done)
          << bench.finished->message;
      if (measuring) {
        EXPECT_THAT(bench.finished->message, HasSubstr(slot.name()));
        EXPECT_EQ(bench.proposals, 0);
      }
    });
  }
}

TEST(RunFsmInterruption, FaultOfADeviceStopsTheTableAndAsks) {
  at_every_step([](RunBench& bench) {
    const bool measuring = bench.solves == 0;
    const bool preflight = !bench.status || bench.status->state == RunState::preflight;
    bench.send(DeviceFaulted{Slot::table(), {bench.now(), "error 1004: motion", "clear the axis"}});
    EXPECT_FALSE(bench.table.moving);
    if (!measuring) return;
    EXPECT_THAT(bench.status->message, HasSubstr("error 1004: motion; clear the axis"));
    EXPECT_EQ(bench.status->state, preflight ? RunState::failed : RunState::paused);
    if (preflight) return;
    bench.send(Request::resume);
    bench.run(400);
    ASSERT_TRUE(bench.finished);
    EXPECT_EQ(bench.finished->state, RunState::done) << bench.finished->message;
  });
}

TEST(RunFsmInterruption, LostReferenceMeansHomingAgain) {
  at_every_step([](RunBench& bench) {
    bench.table.stop();
    bench.table.referenced = false;
    bench.send(bench.reading());
    bench.run(400);
    if (!bench.finished) {  // stopped in its reference move, the table needs the operator
      EXPECT_EQ(bench.status->state, RunState::paused);
      EXPECT_THAT(bench.status->message, HasSubstr("reference move"));
      bench.send(Request::resume);
      bench.run(400);
    }
    ASSERT_TRUE(bench.finished);
    EXPECT_EQ(bench.finished->state, RunState::done) << bench.finished->message;
  });
}

TEST(RunFsmInterruption, ResumedAfterAKillAtEveryStepCompletesThePlan) {
  at_every_step([](RunBench& bench) {
    EarlierLife earlier{WallTime{1'800'000'000'000'000'000}, {}, 0};
    for (const Pose& p : bench.stored) {
      earlier.stored.insert(p.number);
      earlier.last_t_s = *p.t_s;
    }
    RunBench second(short_plan(), quick_config(), earlier);
    second.table = bench.table;  // wherever the dead daemon left it ...
    second.table.stop();         // ... stopped by the driver on opening
    second.run(400);
    ASSERT_TRUE(second.finished);
    EXPECT_EQ(second.finished->state, RunState::done) << second.finished->message;
    EXPECT_EQ(bench.stored.size() + second.stored.size(), 3u);
  });
}

/// Any event in any state: the promises hold (checked by the bench) and the run can still be aborted.
TEST(RunFsmInterruption, EveryEventIsHandledInEveryState) {
  const auto events = [](RunBench& bench) {
    Epoch epoch;
    epoch.t = bench.now();
    return std::vector<Event>{Tick{},
                              Request::pause,
                              Request::resume,
                              epoch,
                              Gap{1, 9, bench.now(), "s1 silent"},
                              ScalarReading{bench.now(), 0, 0, false},
                              TableReading{bench.now(), {1, 1, 1}, true, true, false},
                              TableReading{bench.now(), {}, false, false, true},
                              LinkSeen{Slot::sensor(0), {}},
                              DeviceLost{Slot::sensor(0), "gone"},
                              DeviceLost{Slot::table(), "gone"},
                              DeviceBack{Slot::sensor(0)},
                              DeviceFaulted{Slot::sensor(0), {bench.now(), "what", "remedy"}},
                              PoseStored{99, {}},
                              PoseStored{1, fail(ErrorCode::io, "full")},
                              PosesDropped{{1}, fail(ErrorCode::io, "full")},
                              SolveDone{fail(ErrorCode::internal, "no")},
                              CalibrationProposed{fail(ErrorCode::io, "full")}};
  };
  RunBench first(short_plan(), quick_config());
  const auto count = events(first).size();
  for (std::size_t e = 0; e < count; ++e) {
    for (int n = 0; n < life(); n += 3) {
      SCOPED_TRACE(::testing::Message() << "event " << e << " at step " << n);
      RunBench bench(short_plan(), quick_config());
      for (int i = 0; i < n; ++i) bench.tick();
      bench.send(events(bench)[e]);
      if (bench.finished) continue;
      bench.send(Request::abort);
      bench.run(20);
      ASSERT_TRUE(bench.finished);
      ASSERT_EQ(bench.finished->state, RunState::aborted);
    }
  }
}

/// A long walk of random events on top of a living rig.
TEST(RunFsmInterruption, RandomTroubleNeverBreaksAPromise) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 engine(seed);
    RunBench bench(short_plan(), quick_config());
    const Slot slots[] = {Slot::sensor(0), Slot::sensor(3), Slot::table(), Slot::scalar()};
    for (int i = 0; i < 4000 && !bench.finished; ++i) {
      bench.tick();
      const Slot slot = slots[engine() % 4];
      switch (engine() % 400) {
        case 0:
          bench.send(Request::pause);
          break;
        case 1:
          bench.lose(slot);
          if (slot == Slot::table()) bench.table.stop();
          break;
        case 3:
          bench.disk_full = !bench.disk_full;
          break;
        case 4:
          bench.saturated = !bench.saturated;
          break;
        case 5:
          bench.table.referenced = false;
          bench.table.stop();
          bench.send(bench.reading());
          break;
        case 6:
          bench.send(DeviceFaulted{slot, {bench.now(), "what", "remedy"}});
          break;
        case 7:
        case 8:
          bench.send(Request::resume);
          break;
        case 9:
        case 10:
        case 11:
          bench.give_back(slot);
          break;
        default:
          break;
      }
    }
    bench.disk_full = bench.saturated = false;
    for (const Slot slot : slots) bench.give_back(slot);
    for (int i = 0; i < 20 && !bench.finished; ++i) {
      bench.send(Request::resume);
      bench.run(300);
    }
    ASSERT_TRUE(bench.finished) << bench.status->message;
    if (bench.finished->state == RunState::done) {
      EXPECT_EQ(bench.stored.size(), 3u);
    }
  }
}

}  // namespace
}  // namespace mgtd::daemon::run
