// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/judge_run.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include <nlohmann/json.hpp>

namespace mgtd::daemon::run {
namespace {

using calib::criticism::search::ExplainReport;
using calib::criticism::search::Finding;
using calib::criticism::search::NextReport;
using calib::criticism::search::NextStep;
using ::testing::HasSubstr;

PoseTable ten_poses() {
  PoseTable out;
  for (int k = 0; k < 10; ++k) {
    Pose pose;
    pose.number = k + 1;
    pose.set = "random";
    pose.azimuth_rad = 0.1 * k;
    pose.pitch_rad = pose.roll_rad = 0;
    pose.t_s = 30.0 * k;
    pose.y_nT = PerSensor<Eigen::Vector3d>(4);
    for (auto& y : pose.y_nT) y.setZero();
    out.poses.push_back(pose);
  }
  return out;
}

NextStep step(const char* action, double minutes, double p, bool by_the_rig) {
  return {.measurement = {.action = action, .minutes = minutes, .p_right_before = 0.6, .p_right_after = p},
          .by_the_rig = by_the_rig,
          .of_another_run = false,
          .poses = ten_poses().poses};
}

ExplainReport ambiguous() {
  ExplainReport out;
  out.finding = Finding::ambiguous;
  out.named = {"a", "b"};
  out.rounds.push_back({.added = {.effect = "a"}, .possible = {"b"}});
  return out;
}

/// What follows where two effects are open and these steps are known.
NextPoses choice(std::vector<NextStep> steps, double minutes_left = 30, int looks_left = 3) {
  const PoseTable table = ten_poses();
  const ExplainReport explained = ambiguous();
  NextReport next;
  next.effect = "a", next.alternative = "b", next.steps = std::move(steps);
  return next_poses({.table = table, .explained = explained, .next = next, .discovered = {}}, minutes_left,
                    looks_left);
}

TEST(JudgeRun, TheRigGoesBeforeAHand) {
  const NextPoses out =
      choice({step("a heat pulse", 10, 0.99, false), step("approached from both sides", 12, 0.9, true)});
  EXPECT_EQ(out.judgement.found, "AMBIGUOUS: a or b");
  EXPECT_THAT(out.judgement.next, HasSubstr("approached from both sides, 12 minutes, to tell a from b"));
  EXPECT_THAT(out.judgement.next, HasSubstr("0.900, now 0.600"));
  EXPECT_EQ(out.judgement.minutes, 12);
  ASSERT_EQ(out.poses.size(), 10U);
  EXPECT_TRUE(out.poses.front().note.empty());
}

TEST(JudgeRun, WhatNeedsAHandIsAskedForOnceWithWhatItBrings) {
  const NextPoses out = choice({step("a heat pulse", 10, 0.99, false)});
  ASSERT_EQ(out.poses.size(), 10U);
  EXPECT_THAT(out.poses.front().note, HasSubstr("a heat pulse"));
  EXPECT_THAT(out.poses.front().note, HasSubstr("probability 0.990, now 0.600"));
  EXPECT_TRUE(out.poses[1].note.empty());
}

TEST(JudgeRun, NothingIsMeasuredThatDoesNotPay) {
  NextStep elsewhere = step("at another place", 20, 0.99, false);
  elsewhere.of_another_run = true;
  for (const NextStep& useless :
       {step("too long", 31, 0.99, true), step("no gain", 5, 0.61, true), elsewhere}) {
    const NextPoses out = choice({useless});
    EXPECT_TRUE(out.poses.empty()) << useless.measurement.action;
    EXPECT_EQ(out.judgement.minutes, 0);
    EXPECT_THAT(out.judgement.next, HasSubstr("nothing that can be done within 30 minutes"));
  }
}

TEST(JudgeRun, LooksComeToAnEnd) {
  const NextPoses out = choice({step("more", 5, 0.99, true)}, 30, 0);
  EXPECT_TRUE(out.poses.empty());
  EXPECT_THAT(out.judgement.next, HasSubstr("judged 5 times, which is the limit"));
}

TEST(JudgeRun, AClearVerdictEndsIt) {
  const PoseTable table = ten_poses();
  ExplainReport explained;
  for (const Finding finding : {Finding::pass, Finding::explained, Finding::bad_data, Finding::unknown}) {
    explained.finding = finding;
    const NextPoses out =
        next_poses({.table = table, .explained = explained, .next = {}, .discovered = {}}, 30, 4);
    EXPECT_TRUE(out.poses.empty());
    EXPECT_THAT(out.judgement.found, HasSubstr(std::string(to_string(finding))));
    EXPECT_FALSE(out.judgement.next.empty());
  }
}

/// What no effect explains, and two formulas that these poses do not tell apart.
TEST(JudgeRun, FormulasAreToldApartLikeEffects) {
  const PoseTable table = ten_poses();
  ExplainReport explained;
  explained.finding = Finding::unknown;
  calib::discovery::DiscoveryReport found;
  found.finding = calib::discovery::LawFinding::law_set;
  found.laws.emplace_back();
  found.laws.front().formulas.resize(2);
  found.laws.front().formulas.front().formula = "z^4";
  found.laws.front().formulas.front().where = "s3.z";
  NextReport next;
  next.effect = "z^4", next.alternative = "abs(z)";
  next.steps = {step("where they differ most", 7, 0.97, true)};
  const NextPoses out =
      next_poses({.table = table, .explained = explained, .next = next, .discovered = found}, 30, 4);
  EXPECT_EQ(out.judgement.found, "UNKNOWN; for the rest LAW-SET: z^4 at s3.z");
  EXPECT_THAT(out.judgement.next, HasSubstr("where they differ most, 7 minutes, to tell z^4 from abs(z)"));
  EXPECT_EQ(out.poses.size(), 10U);
}

TEST(JudgeRun, ALawEndsIt) {
  const PoseTable table = ten_poses();
  ExplainReport explained;
  explained.finding = Finding::unknown;
  calib::discovery::DiscoveryReport found;
  found.finding = calib::discovery::LawFinding::law;
  found.laws.emplace_back();
  found.laws.front().formulas.resize(1);
  const NextPoses out =
      next_poses({.table = table, .explained = explained, .next = {}, .discovered = found}, 30, 4);
  EXPECT_TRUE(out.poses.empty());
  EXPECT_THAT(out.judgement.next, HasSubstr("a formula accounts for the rest"));
}

/// Effects that describe a part of a law stand in for it.
TEST(JudgeRun, AFormulaThatAccountsForEverythingTakesThePlaceOfNames) {
  const PoseTable table = ten_poses();
  ExplainReport explained;
  explained.finding = Finding::unknown;
  explained.stand_ins = {"site.step,t=0.4"};
  calib::discovery::DiscoveryReport found;
  found.finding = calib::discovery::LawFinding::law;
  found.laws.emplace_back();
  found.laws.front().formulas.resize(1);
  found.laws.front().formulas.front().formula = "t_h^2";
  found.laws.front().formulas.front().where = "site gradient";
  NextPoses out =
      next_poses({.table = table, .explained = explained, .next = {}, .discovered = found}, 30, 4);
  EXPECT_EQ(out.judgement.found, "LAW: t_h^2 at site gradient; site.step,t=0.4 describes a part of it");
  EXPECT_THAT(out.judgement.next, HasSubstr("a formula accounts for everything"));
  EXPECT_TRUE(out.poses.empty());

  // Beside a name that keeps its place.
  explained.finding = Finding::partial, explained.named = {"axis.cubic"};
  out = next_poses({.table = table, .explained = explained, .next = {}, .discovered = found}, 30, 4);
  EXPECT_EQ(
      out.judgement.found,
      "PARTIAL: axis.cubic; for the rest LAW: t_h^2 at site gradient; site.step,t=0.4 describes a part of "
      "it");
  EXPECT_THAT(out.judgement.next, HasSubstr("a formula accounts for the rest"));
}

/// A part that is named is no end while other names of it are open, whatever a formula says of the rest.
TEST(JudgeRun, APartThatIsOpenIsToldApart) {
  const PoseTable table = ten_poses();
  ExplainReport explained;
  explained.finding = Finding::partial;
  explained.named = {"a"};
  calib::discovery::DiscoveryReport found;
  found.laws.emplace_back();
  found.laws.front().formulas.resize(1);
  NextReport next;
  next.effect = "a", next.alternative = "b";
  next.steps = {step("approached from both sides", 7, 0.97, true)};
  for (const auto finding : {calib::discovery::LawFinding::law, calib::discovery::LawFinding::shape_only}) {
    found.finding = finding;
    const NextPoses out =
        next_poses({.table = table, .explained = explained, .next = next, .discovered = found}, 30, 4);
    EXPECT_THAT(out.judgement.next, HasSubstr("7 minutes, to tell a from b")) << to_string(finding);
    EXPECT_EQ(out.poses.size(), 10U);
  }
}

/// An effect of the library that leads by little is one of several hypotheses.
TEST(JudgeRun, AnEffectThatLeadsByLittleLeavesFormulasOpen) {
  const PoseTable table = ten_poses();
  const ExplainReport explained;
  calib::discovery::DiscoveryReport found;
  found.finding = calib::discovery::LawFinding::library;
  found.reason = {calib::discovery::LawFindingReason::Rule::library, 0.5, 0.98};
  RunEvidence evidence{.table = table, .explained = explained, .next = {}, .discovered = found};
  EXPECT_TRUE(evidence.leaves_formulas_open());
  evidence.discovered->reason.measured = 0.99;
  EXPECT_FALSE(evidence.leaves_formulas_open());
}

TEST(JudgeRun, SaysBesideWhichEffectsTheRestWasSearched) {
  const PoseTable table = ten_poses();
  ExplainReport explained;
  explained.finding = Finding::unknown;
  calib::discovery::DiscoveryReport found;
  RunEvidence evidence{.table = table,
                       .explained = explained,
                       .next = {},
                       .discovered = found,
                       .beside = {"axis.cubic@s3.z"},
                       .model = {"axis.gain.step@s1.x,t=0.4", "axis.cubic@s3.z"}};
  NextPoses out = next_poses(evidence, 30, 4);
  EXPECT_EQ(out.judgement.found, "UNKNOWN; for the rest LIBRARY: axis.cubic@s3.z; for the rest PASS");
  EXPECT_THAT(out.judgement.next,
              HasSubstr("axis.gain.step@s1.x,t=0.4 and axis.cubic@s3.z account for everything"));
  evidence.discovered->finding = calib::discovery::LawFinding::law;
  evidence.discovered->laws.emplace_back();
  evidence.discovered->laws.front().formulas.resize(1);
  out = next_poses(evidence, 30, 4);
  EXPECT_THAT(out.judgement.next,
              HasSubstr("mgt discover --with axis.gain.step@s1.x,t=0.4 --with axis.cubic@s3.z says how to "
                        "keep it"));
}

TEST(RunJudgement, ReadsBackAsItWasWritten) {
  const std::vector<RunJudgement> written{{157, "AMBIGUOUS: a or b", "24 more", 12.5},
                                          {181, "EXPLAINED: a", "clear", 0}};
  const auto read = judgements_from_json(to_json(written).dump());
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, written);
  EXPECT_TRUE(judgements_from_json("")->empty());
  EXPECT_FALSE(judgements_from_json(R"([{"poses":1}])"));
  EXPECT_FALSE(judgements_from_json("[1]"));
}

}  // namespace
}  // namespace mgtd::daemon::run
