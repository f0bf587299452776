// SPDX-License-Identifier: Apache-2.0
#include "calib/design/hypothesis_menu.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "calib/fit/joint/joint_report.h"
#include "tests/blind/hidden_run.h"

namespace mgtd::calib::design {
namespace {

using calib::testing::Hidden;
using ::testing::HasSubstr;

/// Added to s3.z.
PoseTable run_with(const std::function<double(const Pose&, double x)>& law, std::uint64_t seed) {
  const Hidden hidden = [law](const Pose& p, int i, int a, const Eigen::Vector3d& v) {
    return i == 2 && a == 2 ? law(p, v[2] / 5e4) : 0.0;
  };
  return calib::testing::hidden_run({.noise_nT = 0.05, .hidden = hidden}, seed);
}

Hypothesis formula(const std::string& expression, const std::string& where = "s3.z") {
  return {.name = expression, .specs = {"law@" + where + ",level=axis,unit=nT,expr=" + expression}, .P = {}};
}

Result<HypothesisMenu> asked(const PoseTable& run, const std::vector<Hypothesis>& hypotheses,
                             std::span<const LawAction> actions = law_actions()) {
  const fit::joint::JointOptions options = fit::joint::joint_options({});
  const auto fit = fit::joint::fit_joint(run, options);
  if (!fit) return tl::unexpected(fit.error());
  return hypothesis_menu(run, *fit, options, hypotheses, 1, actions);
}

const HypothesisStep* step(const HypothesisMenu& menu, std::string_view words) {
  const auto found = std::find_if(menu.steps.begin(), menu.steps.end(), [&](const HypothesisStep& s) {
    return s.measurement.action.find(words) != std::string::npos;
  });
  return found == menu.steps.end() ? nullptr : &*found;
}

double after(const HypothesisMenu& menu, std::string_view words) {
  const HypothesisStep* const found = step(menu, words);
  return found == nullptr ? 0 : found->measurement.lambda_after.value_or(0);
}

PoseTable quartic() {
  return run_with([](const Pose&, double x) { return 0.25 * std::pow(x, 4); }, 3);
}
const std::vector<Hypothesis> kQuartic{formula("(u/50000)^4"), formula("max(0, abs(u/50000) - 0.6)")};

TEST(HypothesisMenu, PlacedPosesTellMoreThanThoseOfTheRun) {
  const auto menu = asked(quartic(), kQuartic);
  ASSERT_TRUE(menu) << menu.error().text();
  EXPECT_FALSE(menu->hypotheses.assumed);
  const double gain = after(*menu, "differ most") - menu->lambda_before;
  EXPECT_GT(gain, 1.5 * (after(*menu, "as before") - menu->lambda_before));
  ASSERT_FALSE(menu->steps.empty());
  EXPECT_THAT(menu->steps.front().measurement.action, HasSubstr("differ most"));
  // The angles are those that the run had, and nothing but the seed decides.
  const auto again = asked(quartic(), kQuartic);
  ASSERT_TRUE(again);
  const HypothesisStep *const a = step(*menu, "differ most"), *const b = step(*again, "differ most");
  for (std::size_t k = 0; k < kLawPoses; ++k) {
    EXPECT_EQ(a->poses[k].azimuth_rad, b->poses[k].azimuth_rad);
    EXPECT_LE(std::abs(*a->poses[k].pitch_rad), to_rad(90));
  }
}

/// What a fit leaves out must not decide between formulas.
TEST(HypothesisMenu, AReadingThatIsLeftOutCountsForNothing) {
  const auto clean = asked(quartic(), kQuartic);
  ASSERT_TRUE(clean) << clean.error().text();
  for (const double off_nT : {1000.0, 1e6}) {
    PoseTable run = quartic();
    run.poses[70].y_nT[2].z() += off_nT;
    const auto menu = asked(run, kQuartic);
    ASSERT_TRUE(menu) << menu.error().text();
    EXPECT_NEAR(menu->p_right_before, clean->p_right_before, 0.02) << off_nT;
    ASSERT_FALSE(menu->steps.empty()) << off_nT;
    EXPECT_EQ(menu->steps.front().measurement.action, clean->steps.front().measurement.action) << off_nT;
    EXPECT_NEAR(menu->steps.front().measurement.p_right_after, clean->steps.front().measurement.p_right_after,
                0.02)
        << off_nT;
  }
}

TEST(HypothesisMenu, AnActionThatChangesNothingComesLast) {
  std::vector<LawAction> actions;
  for (const LawAction& action : law_actions())
    if (action.by_the_rig || action.text.find("weaker") != std::string_view::npos) actions.push_back(action);
  actions.insert(actions.begin(), {.text = "an hour's rest", .extra_min = 60, .placed = false});
  const auto menu = asked(quartic(), kQuartic, actions);
  ASSERT_TRUE(menu) << menu.error().text();
  ASSERT_GE(menu->steps.size(), 3U);
  EXPECT_EQ(menu->steps.back().measurement.action, "an hour's rest");
}

TEST(HypothesisMenu, HeatTellsTemperatureFromTimeAndOneHeadFromTheOther) {
  // All heads go the same way in this run, up to a constant.
  PoseTable run = run_with([](const Pose& p, double) { return 3 * *p.t_s / 3600; }, 4);
  for (Pose& pose : run.poses)
    for (std::size_t i = 0; i < 4; ++i)
      pose.T_degC[i] = 20 + 2 * *pose.t_s / 3600 + 0.1 * static_cast<double>(i);
  const auto time = asked(run, {formula("t_h"), formula("T_degC - 20")});
  ASSERT_TRUE(time) << time.error().text();
  EXPECT_LT(time->lambda_before, 1e-3);
  EXPECT_LT(after(*time, "differ most"), 1e-3);
  EXPECT_GT(after(*time, "heat step"), criticism::tests::kToldApart);
  EXPECT_GT(after(*time, "another day, 3 degC colder"), criticism::tests::kToldApart);
  const auto head = asked(run, {formula("T_degC - 20"), formula("s2_T_degC - 20")});
  ASSERT_TRUE(head) << head.error().text();
  EXPECT_GT(after(*head, "one head after another"), criticism::tests::kToldApart);
  EXPECT_LT(after(*head, "heat step"), 1e-3);
  ASSERT_EQ(head->steps.size(), 1U);
  EXPECT_FALSE(head->steps.front().by_the_rig);
}

TEST(HypothesisMenu, PairsThatNothingTellsApartAreSetAside) {
  const PoseTable run = run_with([](const Pose& p, double) { return std::pow(*p.t_s / 3600, 2); }, 4);
  const auto menu = asked(run, {formula("t_h^2"), formula("t_h*t_h"), formula("(T_degC - 20)^2")});
  ASSERT_TRUE(menu) << menu.error().text();
  ASSERT_EQ(menu->never.size(), 1U);
  EXPECT_EQ(menu->never.front().truth + menu->never.front().other, 1U);
  EXPECT_NE(menu->worst.truth + menu->worst.other, 1U);
  EXPECT_GT(menu->lambda_before, 0);
}

/// A pair of two unlikely formulas that little helps must not stand in the way of the likely ones.
TEST(HypothesisMenu, LikelyPairsCountMost) {
  PoseTable run = run_with([](const Pose& p, double) { return 3 * *p.t_s / 3600; }, 4);
  for (Pose& pose : run.poses)
    for (std::size_t i = 0; i < 4; ++i)
      pose.T_degC[i] = 20 + 2 * *pose.t_s / 3600 + 0.1 * static_cast<double>(i);
  std::vector<Hypothesis> hypotheses{formula("t_h"), formula("T_degC - 20"), formula("s2_T_degC - 20")};
  hypotheses[0].P = 0.5, hypotheses[1].P = 0.45, hypotheses[2].P = 0.05;
  const auto menu = asked(run, hypotheses);
  ASSERT_TRUE(menu) << menu.error().text();
  EXPECT_EQ(menu->worst.truth + menu->worst.other, 1U);
  ASSERT_NE(step(*menu, "heat step"), nullptr) << "although it does not tell one head from the other";
  EXPECT_GT(step(*menu, "heat step")->measurement.p_right_after, 0.9);
  EXPECT_THAT(menu->steps.front().measurement.action, ::testing::Not(HasSubstr("one head after another")));
}

TEST(HypothesisMenu, OneThatHoldsAnotherIsNoQuestion) {
  std::vector<Hypothesis> hypotheses = kQuartic;
  hypotheses.push_back(formula("(u/50000)^4", "each-axis"));
  const auto menu = asked(quartic(), hypotheses);
  ASSERT_TRUE(menu) << menu.error().text();
  for (const HypothesisPair& pair : menu->hypotheses.pairs) EXPECT_TRUE(pair.truth != 2 && pair.other != 2);
  const auto two = asked(quartic(), {hypotheses[0], hypotheses[2]});
  ASSERT_TRUE(two) << two.error().text();
  EXPECT_EQ(two->hypotheses.pairs.size(), 1U) << "unless nothing else is asked";
}

TEST(HypothesisMenu, WhatTheColumnsCannotExpressIsLeftOutWithTheReason) {
  PoseTable run = quartic();
  for (Pose& pose : run.poses) pose.T_degC.fill(std::nullopt);
  const auto menu = asked(run, kQuartic);
  ASSERT_TRUE(menu) << menu.error().text();
  EXPECT_EQ(step(*menu, "heat step"), nullptr);
  const auto why = [&](std::string_view words) {
    for (const LeftOut& one : menu->left_out)
      if (one.action.find(words) != std::string::npos) return one.why;
    return std::string();
  };
  EXPECT_THAT(why("heat step"), HasSubstr("no temperature"));
  EXPECT_THAT(why("load switched"), HasSubstr("no column"));
  EXPECT_THAT(why("turned in their mounts"), HasSubstr("another array"));
}

/// Of a recording that was turned by hand no rig repeats anything.
TEST(HypothesisMenu, WithoutATableNothingIsDoneByTheRig) {
  PoseTable run = quartic();
  for (Pose& pose : run.poses) pose.azimuth_rad = pose.pitch_rad = pose.roll_rad = std::nullopt;
  const auto menu = asked(run, kQuartic);
  ASSERT_TRUE(menu) << menu.error().text();
  ASSERT_FALSE(menu->steps.empty());
  for (const HypothesisStep& one : menu->steps) EXPECT_FALSE(one.by_the_rig) << one.measurement.action;
}

TEST(HypothesisMenu, LawsThatKnowThePoseBeforeHaveThePosesInOrder) {
  const auto menu = asked(quartic(), {formula("abs(prev_u/50000)"), formula("(prev_u/50000)^2")});
  ASSERT_TRUE(menu) << menu.error().text();
  EXPECT_TRUE(menu->hypotheses.assumed) << "there is nothing of the kind on this run";
  EXPECT_GT(after(*menu, "differ most"), after(*menu, "as before"));
}

TEST(HypothesisMenu, ANumberThatIsLeftOpenIsFoundOnTheRun) {
  const Hypothesis open{.name = "hinge",
                        .specs = {"law@s3.z,level=axis,unit=nT,c=0.1..0.9,expr=max(0, abs(u/50000) - c)"},
                        .P = {}};
  const auto menu = asked(quartic(), {kQuartic[0], open});
  ASSERT_TRUE(menu) << menu.error().text();
  EXPECT_THAT(menu->hypotheses.hypotheses[1].specs.front(), ::testing::Not(HasSubstr("..")));
}

TEST(HypothesisMenu, RefusesWhatTheCalibrationTakesUp) {
  const auto menu = asked(quartic(), {kQuartic[0], formula("u")});
  ASSERT_FALSE(menu);
  EXPECT_THAT(menu.error().message, HasSubstr("takes it up whole"));
  EXPECT_FALSE(asked(quartic(), {kQuartic[0]}));
}

}  // namespace
}  // namespace mgtd::calib::design
