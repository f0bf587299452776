// SPDX-License-Identifier: Apache-2.0
// A run that goes on until its residual is explained.
#include <gmock/gmock.h>

#include "tests/unit/daemon/run/run_bench.h"

namespace mgtd::test {
namespace {

using daemon::run::FurtherPoses;

daemon::run::RunConfig until_explained() {
  daemon::run::RunConfig config = bench_config();
  config.until_explained = true;
  return config;
}

/// Two more poses, with numbers behind those of the plan.
FurtherPoses two_more(int first, const std::string& note = {}) {
  FurtherPoses out{{.poses = first - 1, .found = "AMBIGUOUS: a or b", .next = "two more", .minutes = 1}, {}};
  for (int i = 0; i < 2; ++i)
    out.poses.push_back(
        {.number = first + i, .set = "random", .target = {to_rad(-20.0 * (i + 1)), 0, 0}, .dwell_s = 2});
  out.poses.front().note = note;
  return out;
}

/// Asks for two more once, then has nothing left to explain.
void ask_once(RunBench& bench, const std::string& note = {}) {
  bench.judge = [note](int looks) {
    return looks == 0 ? two_more(4, note)
                      : FurtherPoses{{.poses = 5, .found = "EXPLAINED: a", .next = "clear"}, {}};
  };
}

TEST(RunFsmJudging, MeasuresWhatIsAskedForAndIsJudgedAgain) {
  RunBench bench(bench_plan(3), until_explained());
  ask_once(bench);
  ASSERT_TRUE(bench.run(600));
  EXPECT_EQ(bench.finished->state, RunState::done);
  ASSERT_EQ(bench.stored.size(), 5U);
  EXPECT_EQ(bench.stored.back().number, 5);
  EXPECT_EQ(bench.status->poses, 5);
  EXPECT_EQ(bench.solves, 1);
  ASSERT_EQ(bench.judgements.size(), 2U);
  EXPECT_EQ(bench.judgements.front().plan.poses.size(), 5U);
  EXPECT_EQ(bench.judgements.back().judgement.found, "EXPLAINED: a");
}

/// What is missing was found already.
TEST(RunFsmJudging, ARunThatIsExplainedDoesNotSendToExplain) {
  RunBench bench(bench_plan(3), until_explained());
  ask_once(bench);
  bench.solver = [] {
    return daemon::run::Solution{true, "cal-1", {}, {}, "the model leaves something out"};
  };
  ASSERT_TRUE(bench.run(600));
  EXPECT_THAT(bench.finished->message,
              ::testing::AllOf(::testing::EndsWith("But the model leaves something out: EXPLAINED: a; clear"),
                               ::testing::Not(::testing::HasSubstr("mgt explain"))));
}

/// A crash in between finds the plan that the table moves by.
TEST(RunFsmJudging, ThePlanIsStoredBeforeTheTableMoves) {
  RunBench bench(bench_plan(3), until_explained());
  ask_once(bench);
  ASSERT_TRUE(bench.run(600));
  std::size_t stored = 0, moved = 0;
  for (std::size_t i = 0; i < bench.log.size(); ++i) {
    if (std::holds_alternative<daemon::run::StoreJudgement>(bench.log[i]) && stored == 0) stored = i;
    const auto* const move = std::get_if<daemon::run::MoveTable>(&bench.log[i]);
    if (move != nullptr && std::abs(move->target.azimuth_rad - to_rad(-20)) < 1e-9 && moved == 0) moved = i;
  }
  ASSERT_GT(stored, 0U);
  ASSERT_GT(moved, 0U);
  EXPECT_LT(stored, moved);
}

TEST(RunFsmJudging, AHandIsAskedForItsDeed) {
  RunBench bench(bench_plan(3), until_explained());
  ask_once(bench, "warm the heads by 5 degC");
  ASSERT_TRUE(bench.run_to(RunState::asking));
  EXPECT_EQ(bench.stored.size(), 3U);
  EXPECT_THAT(bench.status->message, ::testing::HasSubstr("warm the heads"));
  bench.send(daemon::run::Request::resume);
  ASSERT_TRUE(bench.run(600));
  EXPECT_EQ(bench.finished->state, RunState::done);
  EXPECT_EQ(bench.stored.size(), 5U);
}

/// Who does not want to do it ends the run with what there is.
TEST(RunFsmJudging, TheOperatorMayFinishInsteadOfTheDeed) {
  RunBench bench(bench_plan(3), until_explained());
  ask_once(bench, "warm the heads by 5 degC");
  ASSERT_TRUE(bench.run_to(RunState::asking));
  bench.send(daemon::run::Request::finish);
  ASSERT_TRUE(bench.run(600));
  EXPECT_EQ(bench.finished->state, RunState::done);
  EXPECT_EQ(bench.stored.size(), 3U);
  EXPECT_EQ(bench.judgements.size(), 1U);
}

TEST(RunFsmJudging, WithoutTheWishNothingIsJudged) {
  RunBench bench(bench_plan(3));
  ask_once(bench);
  ASSERT_TRUE(bench.run(600));
  EXPECT_EQ(bench.stored.size(), 3U);
  EXPECT_TRUE(bench.judgements.empty());
}

TEST(RunFsmJudging, AJudgementThatNeverComesEndsInTheFit) {
  daemon::run::RunConfig config = until_explained();
  config.wait.judge_max_s = 30;
  RunBench bench(bench_plan(3), config);
  bench.judge_stalls = true;
  ASSERT_TRUE(bench.run(600));
  EXPECT_EQ(bench.finished->state, RunState::done);
  EXPECT_EQ(bench.stored.size(), 3U);
}

TEST(RunFsmJudging, AnAbortEndsTheJudgement) {
  RunBench bench(bench_plan(3), until_explained());
  ask_once(bench);
  bench.judge_stalls = true;
  ASSERT_TRUE(bench.run_to(RunState::solving));
  bench.send(daemon::run::Request::abort);
  ASSERT_TRUE(bench.run(60));
  EXPECT_EQ(bench.finished->state, RunState::aborted);
  EXPECT_EQ(bench.solves, 0);
}

/// The daemon died while the poses were judged: they are judged once more, and the table is looked at before
/// it moves.
TEST(RunFsmJudging, AResumedRunIsJudgedAgain) {
  daemon::run::EarlierLife earlier;
  earlier.started_utc = WallTime{1'799'999'000'000'000'000};
  earlier.stored = {1, 2, 3};
  RunBench bench(bench_plan(3), until_explained(), earlier);
  ask_once(bench);
  ASSERT_TRUE(bench.run(600));
  EXPECT_EQ(bench.finished->state, RunState::done);
  ASSERT_EQ(bench.stored.size(), 2U);
  EXPECT_EQ(bench.stored.front().number, 4);
}

/// A device that is lost while the poses are judged is waited for where the next pose begins.
TEST(RunFsmJudging, ADeviceLostMeanwhileIsWaitedFor) {
  RunBench bench(bench_plan(3), until_explained());
  ask_once(bench);
  bench.judge_stalls = true;
  ASSERT_TRUE(bench.run_to(RunState::solving));
  bench.lose(Slot::sensor(1));
  bench.judge_stalls = false;
  ASSERT_TRUE(bench.run(600, [&] { return !bench.judgements.empty(); }));
  bench.run(5);
  EXPECT_EQ(bench.stored.size(), 3U);
  bench.give_back(Slot::sensor(1));
  ASSERT_TRUE(bench.run(600));
  EXPECT_EQ(bench.finished->state, RunState::done);
  EXPECT_EQ(bench.stored.size(), 5U);
}

TEST(RunFsmJudging, ASensorExchangedMeanwhileIsNoticed) {
  RunBench bench(bench_plan(3), until_explained());
  ask_once(bench);
  bench.judge_stalls = true;
  const auto answers = [&](const std::string& identity) {
    LinkHealth health;
    health.state = LinkState::live;
    health.identity = identity;
    bench.send(daemon::run::LinkSeen{Slot::sensor(1), health});
  };
  answers("ObsDAQ, serial 7");
  ASSERT_TRUE(bench.run_to(RunState::solving));
  answers("ObsDAQ, serial 8");
  bench.judge_stalls = false;
  ASSERT_TRUE(bench.run_to(RunState::paused));
  EXPECT_THAT(bench.status->message, ::testing::HasSubstr("serial number 8"));
  EXPECT_FALSE(bench.fsm.possible(daemon::run::Request::resume));
  answers("ObsDAQ, serial 7");
  bench.send(daemon::run::Request::resume);
  ASSERT_TRUE(bench.run(600));
  EXPECT_EQ(bench.finished->state, RunState::done);
  EXPECT_EQ(bench.stored.size(), 5U);
}

}  // namespace
}  // namespace mgtd::test
