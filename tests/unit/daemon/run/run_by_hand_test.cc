// SPDX-License-Identifier: Apache-2.0
// Runs whose operator turns the table or mounts the array, in virtual time.
#include <gmock/gmock.h>

#include "daemon/plan/mount_plan.h"
#include "daemon/plan/mounting.h"
#include "tests/unit/daemon/run/run_bench.h"

namespace mgtd::test {
namespace {

using ::testing::HasSubstr;

TableAngles deg(double azimuth, double pitch, double roll) {
  return {to_rad(azimuth), to_rad(pitch), to_rad(roll)};
}

/// An operator who sets what is asked for to a degree, and reads what is there.
struct Operator {
  double sloppy_rad{to_rad(0.8)};
  std::vector<TableAngles> entries;
  std::vector<std::string> again;

  void serve(
      RunBench& bench, const std::function<void(TableAngles&)>& blunder = [](TableAngles&) {}) {
    ASSERT_LT(entries.size(), 50U) << "asked for ever";
    const OperatorPrompt prompt = *bench.status->prompt;
    if (!prompt.again.empty()) again.push_back(prompt.again);
    TableAngles there = prompt.target;
    there.azimuth_rad += sloppy_rad;
    there.roll_rad -= sloppy_rad / 2;
    (prompt.what == OperatorPrompt::What::mount ? bench.mounting : bench.really.emplace()) = there;
    TableAngles read = there;
    blunder(read);
    entries.push_back(read);
    bench.send(daemon::run::ScaleEntered{read});
  }
};

daemon::run::RunConfig hand_config() {
  daemon::run::RunConfig config = bench_config();
  config.by_hand = true;
  return config;
}

daemon::plan::RunPlan hand_plan(int poses) {
  daemon::plan::PlanOptions options{
      .step_deg = 0, .random = poses, .revisits = 0, .dwell_short_s = 2, .dwell_long_s = 3};
  options.by_hand = true;
  // Less than the table's own travel: hands do not stop on the mark.
  auto plan = daemon::plan::make_plan(
      options, {{to_rad(-170), to_rad(170)}, {to_rad(-80), to_rad(80)}, {to_rad(-170), to_rad(170)}});
  EXPECT_TRUE(plan);
  return *plan;
}

/// Table of one axis: a level standard set of 8 azimuths and 24 poses in three mountings.
daemon::plan::RunPlan mount_plan() {
  daemon::plan::PlanOptions options{
      .step_deg = 45, .random = 24, .revisits = 4, .dwell_short_s = 2, .dwell_long_s = 3};
  options.mounts = {deg(0, 0, 0), deg(0, 0, 90), deg(0, 90, 0)};
  drivers::TableLimits limits = bench_limits();
  limits.pitch = limits.roll = {};
  auto plan = daemon::plan::make_plan(options, limits);
  EXPECT_TRUE(plan) << plan.error().text();
  return *plan;
}

bool to_prompt(RunBench& bench, double limit_s = 600) { return bench.run_to(RunState::asking, limit_s); }

/// The operator answers the next question. Whether so many poses are stored then.
bool measured(RunBench& bench, Operator& hands, std::size_t poses) {
  if (!to_prompt(bench)) return false;
  hands.serve(bench);
  return bench.run(600, [&] { return bench.stored.size() == poses; });
}

/// The operator takes a pose back, and the disk does not drop it.
bool redo_on_a_full_disk(RunBench& bench) {
  bench.disk_full = true;
  bench.send(daemon::run::Request::redo);
  return bench.run_to(RunState::paused);
}

TEST(RunByHand, TheEnteredAngleIsStoredAndNotTheTarget) {
  const daemon::plan::RunPlan plan = hand_plan(12);
  RunBench bench(plan, hand_config());
  Operator hands;
  while (bench.run(4000, [&] { return bench.status && bench.status->prompt.has_value(); }) &&
         !bench.finished && hands.entries.size() < 50)
    hands.serve(bench);
  ASSERT_TRUE(bench.finished);
  EXPECT_EQ(bench.finished->state, RunState::done) << bench.finished->message;
  ASSERT_EQ(bench.stored.size(), 12U);
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_NEAR(*bench.stored[i].azimuth_rad, hands.entries[i].azimuth_rad, 1e-12);
    EXPECT_NEAR(*bench.stored[i].azimuth_rad - plan.poses[i].target.azimuth_rad, to_rad(0.8), 1e-9);
    EXPECT_NEAR(*bench.stored[i].roll_rad - plan.poses[i].target.roll_rad, -to_rad(0.4), 1e-9);
    EXPECT_FALSE(bench.stored[i].sense) << "from which side a hand came is not known";
    EXPECT_EQ(std::fmod(std::abs(to_deg(plan.poses[i].target.azimuth_rad)) + 1e-9, 5.0) < 1e-6, true);
  }
  EXPECT_TRUE(bench.moves.empty()) << "a hand is no motor";
  EXPECT_TRUE(hands.again.empty());
}

TEST(RunByHand, NobodyAnswersAndTheRunPausesWithoutAGuess) {
  RunBench bench(hand_plan(12), hand_config());
  ASSERT_TRUE(to_prompt(bench));
  const double asked_s = bench.t_s;
  ASSERT_TRUE(bench.run_to(RunState::paused, 2000));
  EXPECT_NEAR(bench.t_s - asked_s, 900, 2);
  EXPECT_TRUE(bench.stored.empty());
  EXPECT_THAT(bench.status->message, HasSubstr("nothing was entered"));
  EXPECT_FALSE(bench.fsm.possible(daemon::run::ScaleEntered{}));
  bench.send(daemon::run::Request::resume);
  ASSERT_TRUE(to_prompt(bench));
  EXPECT_EQ(bench.status->prompt->pose, 1);
}

/// Whatever is asked for is entered, as it is read, until the run ends.
template <class Misread>
void serve_all(RunBench& bench, Operator& hands, const Misread& misread) {
  while (bench.run(4000, [&] { return bench.status && bench.status->prompt.has_value(); }) &&
         !bench.finished && hands.entries.size() < 50)
    hands.serve(bench, misread);
}

/// The field tells nothing yet.
TEST(RunByHand, AnEntryFarFromWhatWasAskedForIsAskedForAgain) {
  RunBench bench(hand_plan(12), hand_config());
  Operator hands;
  int prompts = 0;
  serve_all(bench, hands, [&](TableAngles& read) {
    if (++prompts == 2) read.roll_rad += to_rad(read.roll_rad > 0 ? -30 : 30);
  });
  EXPECT_EQ(bench.finished->state, RunState::done);
  ASSERT_EQ(hands.again.size(), 1U);
  EXPECT_THAT(hands.again[0], HasSubstr("was entered where"));
  ASSERT_EQ(bench.stored.size(), 12U);
  EXPECT_NEAR(*bench.stored[1].roll_rad, hands.entries[2].roll_rad, 1e-12);
}

TEST(RunByHand, ABlunderThatIsRepeatedIsNoticedByTheTurnOfTheField) {
  RunBench bench(hand_plan(12), hand_config());
  Operator hands;
  int prompts = 0;
  serve_all(bench, hands, [&](TableAngles& read) {
    if (++prompts == 8 || prompts == 9) read.pitch_rad += to_rad(read.pitch_rad > 0 ? -60 : 60);
  });
  EXPECT_EQ(bench.finished->state, RunState::done);
  ASSERT_EQ(hands.again.size(), 2U);
  EXPECT_THAT(hands.again[1], HasSubstr("the field turned by"));
  ASSERT_EQ(bench.stored.size(), 12U);
  EXPECT_EQ(prompts, 14);
  EXPECT_NEAR(*bench.stored[7].pitch_rad, hands.entries[9].pitch_rad, 1e-12) << "the last entry counts";
}

TEST(RunByHand, TheSameEntryTwiceIsTheOperatorsWord) {
  RunBench bench(hand_plan(12), hand_config());
  Operator hands;
  serve_all(bench, hands, [&](TableAngles& read) {
    if (bench.status->prompt->pose == 8) read.pitch_rad += to_rad(read.pitch_rad > 0 ? -60 : 60);
  });
  EXPECT_EQ(hands.again.size(), 2U);  // far from what was asked for, and against the turn of the field
  EXPECT_EQ(bench.stored.size(), 12U);
  const bool said = std::any_of(bench.log.begin(), bench.log.end(), [](const daemon::run::Action& a) {
    const auto* const record = std::get_if<daemon::run::Record>(&a);
    return record != nullptr && record->what.find("stands by the entry") != std::string::npos;
  });
  EXPECT_TRUE(said);
}

TEST(RunByHand, RedoAsksForTheLastPoseAgainAndDropsIt) {
  RunBench bench(hand_plan(12), hand_config());
  Operator hands;
  for (std::size_t k = 1; k <= 3; ++k) ASSERT_TRUE(measured(bench, hands, k));
  ASSERT_TRUE(to_prompt(bench));
  ASSERT_EQ(bench.status->prompt->pose, 4);
  bench.send(daemon::run::Request::redo);
  ASSERT_TRUE(to_prompt(bench));
  EXPECT_EQ(bench.status->prompt->pose, 3);
  EXPECT_EQ(bench.stored.size(), 2U);
  EXPECT_EQ(bench.dropped, 1);
  const auto twice = bench.fsm.possible(daemon::run::Request::redo);
  ASSERT_FALSE(twice);
  EXPECT_NE(twice.error().message.find("asked for again already"), std::string::npos) << twice.error().text();
  ASSERT_TRUE(measured(bench, hands, 3));
  EXPECT_EQ(bench.stored.back().number, 3);
}

/// What the operator took back is neither fitted nor in the way of its new measurement.
TEST(RunByHand, APoseThatTheDiskDoesNotDropPausesTheRun) {
  RunBench bench(hand_plan(12), hand_config());
  Operator hands;
  for (std::size_t k = 1; k <= 3; ++k) ASSERT_TRUE(measured(bench, hands, k));
  ASSERT_TRUE(to_prompt(bench));
  ASSERT_TRUE(redo_on_a_full_disk(bench));
  EXPECT_THAT(bench.status->message, HasSubstr("pose 3 is to be measured again but could not be taken out"));
  EXPECT_THAT(bench.status->message, HasSubstr("free some space"));
  bench.send(daemon::run::Request::finish);
  ASSERT_TRUE(bench.run_to(RunState::paused)) << "its poses are not fitted with the wrong one among them";
  EXPECT_EQ(bench.proposals, 0);
  bench.disk_full = false;
  bench.send(daemon::run::Request::resume);
  ASSERT_TRUE(bench.run(600));
  EXPECT_EQ(bench.finished->state, RunState::done);
  EXPECT_EQ(bench.stored.size(), 2U);
}

TEST(RunByHand, AnAbortDropsWhatAFullDiskKept) {
  RunBench bench(hand_plan(12), hand_config());
  Operator hands;
  ASSERT_TRUE(measured(bench, hands, 1));
  ASSERT_TRUE(redo_on_a_full_disk(bench));
  bench.disk_full = false;
  bench.send(daemon::run::Request::abort);
  ASSERT_TRUE(bench.run(600));
  EXPECT_EQ(bench.finished->state, RunState::aborted);
  EXPECT_TRUE(bench.stored.empty());
}

TEST(RunByHand, APoseThatTheDiskDropsLaterIsMeasuredAgain) {
  RunBench bench(hand_plan(12), hand_config());
  Operator hands;
  ASSERT_TRUE(measured(bench, hands, 1));
  ASSERT_TRUE(redo_on_a_full_disk(bench));
  bench.disk_full = false;
  bench.send(daemon::run::Request::resume);
  ASSERT_TRUE(to_prompt(bench));
  EXPECT_TRUE(bench.stored.empty());
  EXPECT_EQ(bench.status->prompt->pose, 1);
  ASSERT_TRUE(measured(bench, hands, 1));
}

/// The last entry is that of the pose under way, which the pause forgot: the pose before stays.
TEST(RunByHand, RedoAfterAPauseAsksForThePoseUnderWayAgain) {
  RunBench bench(hand_plan(12), hand_config());
  Operator hands;
  ASSERT_TRUE(measured(bench, hands, 1));
  ASSERT_TRUE(to_prompt(bench));
  hands.serve(bench);
  ASSERT_FALSE(bench.status->prompt.has_value()) << "pose 2 is being measured";
  bench.send(daemon::run::Request::pause);
  ASSERT_TRUE(bench.fsm.possible(daemon::run::Request::redo));
  bench.send(daemon::run::Request::redo);
  ASSERT_TRUE(to_prompt(bench));
  EXPECT_EQ(bench.status->prompt->pose, 2);
  EXPECT_EQ(bench.dropped, 0);
  EXPECT_EQ(bench.stored.size(), 1U);
}

/// Two terminals show the same question, and both are answered.
TEST(RunByHand, AnAnswerToAnEarlierQuestionIsNotTaken) {
  RunBench bench(hand_plan(12), hand_config());
  ASSERT_TRUE(to_prompt(bench));
  daemon::run::ScaleEntered entry{bench.status->prompt->target, bench.status->prompt->pose};
  bench.really = entry.angles;
  bench.send(entry);
  ASSERT_TRUE(bench.run(600, [&] { return bench.stored.size() == 1; }));
  ASSERT_TRUE(to_prompt(bench));
  ASSERT_EQ(bench.status->prompt->pose, 2);
  const auto late = bench.fsm.possible(entry);
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, ErrorCode::state);
  EXPECT_THAT(late.error().message, HasSubstr("asked is now: pose 2 of 12"));
  entry.pose = 2;
  EXPECT_TRUE(bench.fsm.possible(entry));
}

TEST(RunByHand, WhatIsEnteredOutsideTheLimitsIsRefused) {
  RunBench bench(hand_plan(12), hand_config());
  ASSERT_TRUE(to_prompt(bench));
  const auto possible = bench.fsm.possible(daemon::run::ScaleEntered{deg(0, 120, 0)});
  ASSERT_FALSE(possible);
  EXPECT_THAT(possible.error().message, HasSubstr("limits"));
  EXPECT_TRUE(bench.fsm.possible(daemon::run::ScaleEntered{deg(0, 60, 0)}));
}

TEST(RunByHand, AOneAxisTableAlternatesMountingsWithDrivenAzimuths) {
  const daemon::plan::RunPlan plan = mount_plan();
  daemon::run::RunConfig config = bench_config();
  config.limits.pitch = config.limits.roll = {};
  RunBench bench(plan, config);
  Operator hands;
  while (bench.run(9000, [&] { return bench.status && bench.status->prompt.has_value(); }) &&
         !bench.finished && hands.entries.size() < 50)
    hands.serve(bench);
  ASSERT_TRUE(bench.finished);
  EXPECT_EQ(bench.finished->state, RunState::done) << bench.finished->message;
  ASSERT_EQ(bench.stored.size(), 32U);
  EXPECT_EQ(hands.entries.size(), 4U) << "three ways, and the first once more";
  EXPECT_TRUE(hands.again.empty()) << hands.again.front();
  EXPECT_GE(bench.moves.size(), 32U);
  std::set<int> mounts;
  for (std::size_t i = 0; i < bench.stored.size(); ++i) {
    const Pose& pose = bench.stored[i];
    ASSERT_TRUE(pose.mount);
    mounts.insert(*pose.mount);
    const TableAngles entered = hands.entries[static_cast<std::size_t>(*pose.mount - 1)];
    const TableAngles expected = daemon::plan::platform_angles(entered, plan.poses[i].target);
    EXPECT_NEAR(std::remainder(*pose.azimuth_rad - expected.azimuth_rad, 2 * std::numbers::pi), 0, 1e-6);
    EXPECT_NEAR(*pose.pitch_rad, expected.pitch_rad, 1e-6);
  }
  EXPECT_EQ(mounts, (std::set<int>{1, 2, 3, 4}));
}

TEST(RunByHand, RedoOfAMountingMeasuresItsPosesAgain) {
  daemon::run::RunConfig config = bench_config();
  config.limits.pitch = config.limits.roll = {};
  RunBench bench(mount_plan(), config);
  Operator hands;
  ASSERT_TRUE(measured(bench, hands, 3));
  ASSERT_TRUE(bench.run_to(RunState::moving));
  bench.send(daemon::run::Request::redo);
  ASSERT_TRUE(to_prompt(bench));
  EXPECT_EQ(bench.status->prompt->mount, 1);
  EXPECT_TRUE(bench.stored.empty());
  ASSERT_TRUE(measured(bench, hands, 3));
}

TEST(RunByHand, AfterARestartTheMountingIsAskedForAgain) {
  daemon::run::RunConfig config = bench_config();
  config.limits.pitch = config.limits.roll = {};
  daemon::run::EarlierLife earlier;
  earlier.stored = {1, 2, 3};
  earlier.started_utc = WallTime{1'799'999'000'000'000'000};
  RunBench bench(mount_plan(), config, earlier);
  ASSERT_TRUE(to_prompt(bench));
  EXPECT_EQ(bench.status->prompt->pose, 4);
  EXPECT_EQ(bench.status->prompt->mount, 1);
}

/// A heat pulse, a coil: what only a hand can do before a pose.
TEST(RunByHand, WhatAListWantsDoneBeforeAPoseIsAskedForOnce) {
  daemon::plan::RunPlan plan = bench_plan(4);
  plan.poses[1].note = "warm the heads";
  RunBench bench(plan);
  ASSERT_TRUE(to_prompt(bench));
  EXPECT_EQ(bench.stored.size(), 1U);
  ASSERT_TRUE(bench.status->prompt);
  EXPECT_EQ(bench.status->prompt->what, OperatorPrompt::What::note);
  EXPECT_EQ(bench.status->prompt->pose, 2);
  EXPECT_EQ(bench.status->prompt->text, "before pose 2 of 4: warm the heads");
  const auto scales = bench.fsm.possible(daemon::run::ScaleEntered{});
  ASSERT_FALSE(scales);
  EXPECT_THAT(scales.error().remedy, HasSubstr("mgt run resume"));
  const std::size_t moves = bench.moves.size();
  bench.run(60);
  EXPECT_EQ(bench.moves.size(), moves) << "nobody said that it is done";
  bench.send(daemon::run::Request::pause);  // not done yet: asked again
  ASSERT_TRUE(bench.run_to(RunState::paused));
  bench.send(daemon::run::Request::resume);
  ASSERT_TRUE(to_prompt(bench));
  ASSERT_TRUE(bench.fsm.possible(daemon::run::Request::resume));
  bench.send(daemon::run::Request::resume);
  ASSERT_TRUE(bench.run_to(RunState::dwelling));
  bench.send(daemon::run::Request::pause);  // done: a pose that is measured again does not ask for it again
  ASSERT_TRUE(bench.run_to(RunState::paused));
  bench.send(daemon::run::Request::resume);
  ASSERT_TRUE(bench.run(600));
  ASSERT_TRUE(bench.finished);
  EXPECT_EQ(bench.finished->state, RunState::done) << bench.finished->message;
  EXPECT_EQ(bench.stored.size(), 4U);
}

/// On a table that is turned by hand the note comes first, then the scales.
TEST(RunByHand, ANoteAndTheScalesAreAskedForOneAfterTheOther) {
  daemon::plan::RunPlan plan = hand_plan(12);
  plan.poses[0].note = "switch the coil on";
  RunBench bench(plan, hand_config());
  ASSERT_TRUE(to_prompt(bench));
  EXPECT_EQ(bench.status->prompt->what, OperatorPrompt::What::note);
  bench.send(daemon::run::Request::resume);
  ASSERT_TRUE(bench.run(
      10, [&] { return bench.status->prompt && bench.status->prompt->what == OperatorPrompt::What::table; }));
  EXPECT_EQ(bench.status->prompt->pose, 1);
}

TEST(RunByHand, WaysToMountAreReadAndSaid) {
  EXPECT_EQ(*daemon::plan::parse_mounting("level"), TableAngles{});
  EXPECT_NEAR(daemon::plan::parse_mounting("pitch 20 roll -90")->roll_rad, to_rad(-90), 1e-12);
  EXPECT_EQ(daemon::plan::mounting_in_words(*daemon::plan::parse_mounting("roll 90")), "roll 90 deg");
  for (const char* const bad : {"", "sideways", "roll", "roll x", "roll 400", "yaw 3"})
    EXPECT_FALSE(daemon::plan::parse_mounting(bad)) << bad;
}

}  // namespace
}  // namespace mgtd::test
