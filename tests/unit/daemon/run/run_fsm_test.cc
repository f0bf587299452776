// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/run_fsm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/daemon/run/run_bench.h"

namespace mgtd::daemon::run {
namespace {

using test::bench_config;
using test::bench_plan;
using test::RunBench;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

bool ends(RunBench& bench, RunState state, double limit_s = 3000) {
  const bool ended = bench.run(limit_s);
  EXPECT_TRUE(ended) << "still " << name(bench.status->state) << ": " << bench.status->message;
  if (!bench.finished) return false;
  EXPECT_EQ(name(bench.finished->state), name(state)) << bench.finished->message;
  EXPECT_TRUE(bench.fsm.ended());
  return bench.finished->state == state;
}

TEST(RunFsm, WholeRunOf157PosesEndsWithAProposal) {
  const auto plan = plan::make_plan({}, test::bench_limits());
  ASSERT_TRUE(plan);
  RunBench bench(*plan);
  ASSERT_TRUE(ends(bench, RunState::done, 7200));
  EXPECT_EQ(bench.stored.size(), 157u);
  EXPECT_EQ(bench.solves, 1);
  EXPECT_EQ(bench.proposals, 1);
  EXPECT_EQ(bench.status->proposed, "cal-1");
  EXPECT_EQ(bench.status->pose, 157);
  EXPECT_EQ(bench.status->retries, 0);
  EXPECT_EQ(bench.states.front(), RunState::preflight);
  EXPECT_EQ(bench.states[1], RunState::homing);
  for (std::size_t i = 0; i < plan->poses.size(); ++i) {
    EXPECT_EQ(bench.stored[i].number, plan->poses[i].number);
    EXPECT_EQ(bench.stored[i].set, plan->poses[i].set);
    EXPECT_NEAR(*bench.stored[i].azimuth_rad, plan->poses[i].target.azimuth_rad, 1e-9);
    EXPECT_TRUE(bench.stored[i].f_nT);
    EXPECT_TRUE(bench.stored[i].since_stop_s);
    EXPECT_EQ(bench.stored[i].dwell_s, plan->poses[i].dwell_s);
    ASSERT_TRUE(bench.stored[i].sense);
    // The first pose stands at the end of the travel: there is no room to come from the other side.
    if (plan->poses[i].sense != 0 && i > 0) {
      EXPECT_EQ(*bench.stored[i].sense, plan->poses[i].sense) << i;
    }
    if (i > 0) {
      EXPECT_GT(*bench.stored[i].t_s, *bench.stored[i - 1].t_s);
    }
  }
  EXPECT_EQ(*bench.stored[0].sense, -1);
}

TEST(RunFsm, StatesFollowOneAnother) {
  RunBench bench(bench_plan(1));
  ASSERT_TRUE(ends(bench, RunState::done));
  EXPECT_THAT(bench.states,
              ElementsAre(RunState::preflight, RunState::homing, RunState::moving, RunState::settling,
                          RunState::dwelling, RunState::solving, RunState::done));
}

/// The poses and the way of the table stay as far apart as they were measured.
TEST(RunFsm, AClockThatIsSetDuringTheRunMovesNothing) {
  for (const double set_s : {-3600.0, 7200.0}) {
    SCOPED_TRACE(set_s);
    RunBench bench(bench_plan(4));
    ASSERT_TRUE(bench.run(600, [&] { return bench.stored.size() == 2; }));
    bench.clock_set_s = set_s;
    ASSERT_TRUE(ends(bench, RunState::done));
    ASSERT_EQ(bench.stored.size(), 4U);
    const Stamp begun = RunBench(bench_plan(4)).now();
    for (const Pose& pose : bench.stored)
      EXPECT_NEAR(to_seconds(Duration{pose.t_utc->ns - begun.wall.ns}), *pose.t_s, 1e-6) << pose.number;
    std::size_t on_the_way = 0;
    for (const Action& action : bench.log) {
      const auto* const path = std::get_if<StorePath>(&action);
      if (path == nullptr) continue;
      for (const TableReading& reading : path->readings) {
        EXPECT_EQ(reading.arrival.wall.ns - begun.wall.ns, (reading.arrival.mono - begun.mono).count());
        ++on_the_way;
      }
    }
    EXPECT_GT(on_the_way, 8U);
  }
}

TEST(RunFsm, TheEstimateOfTheRestLearnsFromThePoses) {
  auto config = bench_config();
  config.pace.velocity_rad_per_s = to_rad(300);  // ten times what the table does
  config.pace.settle_s = 0.1;
  const auto plan = plan::make_plan({.step_deg = 20, .random = 40, .revisits = 5}, test::bench_limits());
  ASSERT_TRUE(plan);
  RunBench bench(*plan, config);
  ASSERT_TRUE(bench.run(3000, [&] { return bench.stored.size() == 38; }));
  const double foreseen_s = bench.fsm.status(bench.now().mono).remaining_s, at_s = bench.t_s;
  ASSERT_TRUE(ends(bench, RunState::done));
  EXPECT_NEAR(foreseen_s, bench.t_s - at_s, 0.25 * (bench.t_s - at_s));  // 20 random travels scatter by 10 %
}

// ---- ends early

TEST(RunFsm, EndsWhenTheTensorIsKnownAsWellAsWanted) {
  auto config = bench_config();
  config.until_tensor_sd_nT_per_m = 2;
  RunBench bench(bench_plan(6), config);
  ASSERT_TRUE(bench.run(600, [&] { return bench.stored.size() == 2; }));
  bench.send(AccuracyKnown{2, 2.5});
  ASSERT_TRUE(bench.run(600, [&] { return bench.stored.size() == 3; }));
  EXPECT_EQ(bench.status->tensor_sd_nT_per_m, 2.5);
  EXPECT_EQ(bench.status->wanted_tensor_sd_nT_per_m, 2);
  bench.run(0.5);
  ASSERT_EQ(bench.status->state, RunState::moving);  // to the fourth: not worth the way
  bench.send(AccuracyKnown{3, 1.9});
  ASSERT_TRUE(ends(bench, RunState::done));
  EXPECT_EQ(bench.stored.size(), 3u);
  EXPECT_EQ(bench.solves, 1);
}

TEST(RunFsm, WithoutAWishTheAccuracyChangesNothing) {
  RunBench bench(bench_plan(3));
  ASSERT_TRUE(bench.run(600, [&] { return bench.stored.size() == 1; }));
  bench.send(AccuracyKnown{1, 1e-6});
  ASSERT_TRUE(ends(bench, RunState::done));
  EXPECT_EQ(bench.stored.size(), 3u);
}

TEST(RunFsm, TheOperatorMayFinishEarly) {
  for (const RunState state : {RunState::moving, RunState::dwelling, RunState::paused}) {
    SCOPED_TRACE(name(state));
    RunBench bench(bench_plan(6));
    ASSERT_TRUE(bench.run(600, [&] { return bench.stored.size() == 1; }));
    const auto too_early = bench.fsm.possible(Request::finish);
    ASSERT_FALSE(too_early);
    EXPECT_THAT(too_early.error().message,
                HasSubstr("1 poses are measured, and a calibration needs at least 2"));
    ASSERT_TRUE(bench.run(600, [&] { return bench.stored.size() == 2; }));
    if (state == RunState::paused) bench.send(Request::pause);
    ASSERT_TRUE(bench.run_to(state));
    bench.send(Request::finish);
    ASSERT_TRUE(ends(bench, RunState::done));
    EXPECT_EQ(bench.stored.size(), state == RunState::dwelling ? 3u : 2u);
    EXPECT_EQ(bench.solves, 1);
  }
}

// ---- preflight

TEST(RunFsm, FailedPreflightMovesNothingAndSaysWhatToDo) {
  RunBench bench(bench_plan(3));
  bench.frozen[2] = true;
  ASSERT_TRUE(ends(bench, RunState::failed));
  EXPECT_TRUE(bench.moves.empty());
  EXPECT_THAT(bench.finished->message, HasSubstr("alive.s3"));
  EXPECT_FALSE(bench.status->checks.empty());
}

TEST(RunFsm, RunWithPosesPausesWhenItsPreflightFails) {
  RunBench bench(bench_plan(3), bench_config(), EarlierLife{WallTime{1'799'999'000'000'000'000}, {1}, 900});
  bench.silent = {Slot::scalar()};
  ASSERT_TRUE(bench.run_to(RunState::paused));
  EXPECT_THAT(bench.status->message, HasSubstr("scalar"));
  bench.silent.clear();
  bench.send(Request::resume);
  ASSERT_TRUE(ends(bench, RunState::done));
  EXPECT_EQ(bench.stored.size(), 2u);
}

// ---- bad poses

TEST(RunFsm, PoseWithTooManyGapsIsMeasuredAgain) {
  RunBench bench(bench_plan(2));
  ASSERT_TRUE(bench.run_to(RunState::dwelling));
  bench.silent = {Slot::sensor(1)};  // silent, the port stays
  bench.run(1.5);
  bench.silent.clear();
  ASSERT_TRUE(ends(bench, RunState::done));
  EXPECT_EQ(bench.status->retries, 1);
  EXPECT_EQ(bench.stored.size(), 2u);
}

TEST(RunFsm, PoseThatStaysBadPausesTheRunWithTheReason) {
  RunBench bench(bench_plan(2));
  ASSERT_TRUE(bench.run_to(RunState::dwelling));
  bench.saturated = true;
  ASSERT_TRUE(bench.run_to(RunState::paused));
  EXPECT_THAT(bench.status->message, HasSubstr("saturated"));
  EXPECT_THAT(bench.status->message, HasSubstr("attempt 4"));
  EXPECT_TRUE(bench.stored.empty());
  bench.saturated = false;
  bench.send(Request::resume);
  ASSERT_TRUE(ends(bench, RunState::done));
  EXPECT_EQ(bench.stored.size(), 2u);
}

TEST(RunFsm, DisturbedDwellIsMeasuredAgain) {
  RunBench bench(bench_plan(2));
  ASSERT_TRUE(bench.run_to(RunState::dwelling));
  bench.disturbance_nT = 30;
  bench.run(2.2);
  bench.disturbance_nT = 0;
  ASSERT_TRUE(ends(bench, RunState::done));
  EXPECT_EQ(bench.status->retries, 1);
  ASSERT_EQ(bench.disturbed.size(), 1u);
  EXPECT_EQ(bench.disturbed.front().pose, 1);
  EXPECT_GT(bench.disturbed.front().seen.change_nT, 10);
}

TEST(RunFsm, DisturbanceThatStaysIsNotSettled) {
  RunBench bench(bench_plan(2));
  ASSERT_TRUE(bench.run_to(RunState::moving));
  bench.disturbance_nT = 30;
  ASSERT_TRUE(bench.run_to(RunState::paused));
  EXPECT_THAT(bench.status->message, HasSubstr("not settled"));
}

TEST(RunFsm, FrozenSensorInTheDwellIsMeasuredAgain) {
  RunBench bench(bench_plan(2));
  ASSERT_TRUE(bench.run_to(RunState::dwelling));
  bench.frozen[3] = true;
  bench.run(1.9);
  bench.frozen[3] = false;
  ASSERT_TRUE(ends(bench, RunState::done));
  EXPECT_EQ(bench.status->retries, 1);
}

TEST(RunFsm, TableThatMovesInTheDwellSpoilsThePose) {
  RunBench bench(bench_plan(2));
  ASSERT_TRUE(bench.run_to(RunState::dwelling));
  bench.table.at.azimuth_rad += to_rad(3);
  ASSERT_TRUE(ends(bench, RunState::done));
  EXPECT_EQ(bench.status->retries, 1);
  EXPECT_NEAR(*bench.stored[0].azimuth_rad, to_rad(40), 1e-9);
}

TEST(RunFsm, StuckTableIsStoppedAndThePoseTriedAgain) {
  RunBench bench(bench_plan(2));
  ASSERT_TRUE(bench.run_to(RunState::moving));
  bench.table.stuck = true;
  const int stops = bench.stops;
  ASSERT_TRUE(bench.run(300, [&] { return bench.stops > stops; }));
  bench.table.stuck = false;
  ASSERT_TRUE(ends(bench, RunState::done));
  EXPECT_EQ(bench.status->retries, 1);
}

TEST(RunFsm, TableRestingElsewhereHasNotArrived) {
  RunBench bench(bench_plan(1));
  ASSERT_TRUE(bench.run_to(RunState::moving));
  bench.table.stop();  // says "on target" where it stands
  ASSERT_TRUE(bench.run(300, [&] { return bench.fsm.status(bench.now().mono).retries == 1; }));
  EXPECT_TRUE(bench.stored.empty());
  ASSERT_TRUE(ends(bench, RunState::done));
}

TEST(RunFsm, ScalarThatFallsSilentSpoilsThePose) {
  RunBench bench(bench_plan(2));
  ASSERT_TRUE(bench.run_to(RunState::settling));
  bench.silent = {Slot::scalar()};
  ASSERT_TRUE(bench.run_to(RunState::paused));
  EXPECT_THAT(bench.status->message, HasSubstr("scalar reference"));
}

// ---- storing

TEST(RunFsm, FullDiskStopsSafelyAndThePoseIsRepeatedAfterwards) {
  RunBench bench(bench_plan(3));
  ASSERT_TRUE(bench.run(600, [&] { return bench.stored.size() == 1; }));
  bench.disk_full = true;
  ASSERT_TRUE(bench.run_to(RunState::paused));
  EXPECT_THAT(bench.status->message, HasSubstr("no space left on device; free some space"));
  EXPECT_FALSE(bench.table.moving);
  bench.run(60);
  EXPECT_EQ(bench.status->state, RunState::paused);
  bench.disk_full = false;
  bench.send(Request::resume);
  ASSERT_TRUE(ends(bench, RunState::done));
  EXPECT_EQ(bench.stored.size(), 3u);
}

TEST(RunFsm, DiskThatDoesNotAnswerNeverLetsTheTableGoOn) {
  RunBench bench(bench_plan(3));
  bench.disk_stalls = true;
  ASSERT_TRUE(bench.run_to(RunState::paused));
  EXPECT_THAT(bench.status->message, HasSubstr("not on disk"));
  bench.send(Request::resume);  // still not: waits again
  bench.run(5);
  EXPECT_EQ(bench.moves.size(), 1u);
  bench.disk_stalls = false;
  ASSERT_TRUE(ends(bench, RunState::done));
  EXPECT_EQ(bench.stored.size(), 3u);
}

// ---- checks of the calibration

TEST(RunFsm, CalibrationThatFailsItsChecksIsNotProposed) {
  RunBench bench(bench_plan(2));
  bench.solver = [] { return Solution{false, "cal-1", {"chi-square is 40 per degree of freedom"}, {}}; };
  ASSERT_TRUE(ends(bench, RunState::rejected));
  EXPECT_EQ(bench.proposals, 0);
  EXPECT_THAT(bench.finished->message, HasSubstr("chi-square"));
}

TEST(RunFsm, WhatTheModelLeavesOutIsSaidWithTheProposal) {
  RunBench bench(bench_plan(2));
  bench.solver = [] {
    return Solution{true, "cal-1", {}, {}, "the model leaves something out: the residual is 5 nT"};
  };
  ASSERT_TRUE(ends(bench, RunState::done));
  EXPECT_THAT(bench.finished->message,
              HasSubstr("But the model leaves something out: the residual is 5 nT: mgt explain says"));
}

TEST(RunFsm, RefusedFitIsARejectedRun) {
  RunBench bench(bench_plan(2));
  bench.solver = []() -> Result<Solution> {
    return fail(ErrorCode::refused, "poses about one axis only", "turn about a second axis");
  };
  ASSERT_TRUE(ends(bench, RunState::rejected));
  EXPECT_THAT(bench.finished->message, HasSubstr("turn about a second axis"));
}

TEST(RunFsm, FitThatNeverAnswersFailsTheRun) {
  RunBench bench(bench_plan(1));
  bench.solve_stalls = true;
  ASSERT_TRUE(ends(bench, RunState::failed));
  EXPECT_EQ(bench.proposals, 0);
}

TEST(RunFsm, CalibrationThatCannotBeKeptFailsTheRun) {
  RunBench bench(bench_plan(1));
  bench.propose_fails = true;
  ASSERT_TRUE(ends(bench, RunState::failed));
  EXPECT_THAT(bench.finished->message, HasSubstr("no space left"));
}

// ---- resume

TEST(RunFsm, InterruptedRunHomesAndGoesOnAtTheNextPose) {
  RunBench first(bench_plan(4));
  ASSERT_TRUE(first.run(600, [&] { return first.stored.size() == 2; }));
  EarlierLife earlier{WallTime{first.now().wall.ns - from_seconds(first.t_s).count()}, {}, 0};
  for (const Pose& p : first.stored) {
    earlier.stored.insert(p.number);
    earlier.last_t_s = *p.t_s;
  }
  RunBench second(bench_plan(4), bench_config(), earlier);  // its clock starts where the first one's did
  ASSERT_TRUE(ends(second, RunState::done));
  ASSERT_EQ(second.stored.size(), 2u);
  EXPECT_EQ(second.stored[0].number, 3);
  EXPECT_GT(*second.stored[0].t_s, *first.stored[1].t_s);
  EXPECT_THAT(second.states, ::testing::Contains(RunState::homing));
}

TEST(RunFsm, ResumedWithAllPosesOnlyFits) {
  RunBench bench(bench_plan(2), bench_config(), EarlierLife{WallTime{1'799'999'000'000'000'000}, {1, 2}, 90});
  bench.run(60);
  EXPECT_EQ(bench.solves, 1);
  EXPECT_TRUE(bench.moves.empty());
}

TEST(RunFsm, PlanOutsideTheLimitsOfTodayPauses) {
  auto config = bench_config();
  config.limits.azimuth = {to_rad(-60), to_rad(60)};
  RunBench bench(bench_plan(2), config);  // 40, then 80 degrees
  ASSERT_TRUE(bench.run_to(RunState::paused));
  EXPECT_EQ(bench.stored.size(), 1u);
  EXPECT_THAT(bench.status->message, HasSubstr("outside the table's limits"));
}

}  // namespace
}  // namespace mgtd::daemon::run
