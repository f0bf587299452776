// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/next_pair.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "calib/effects/effect_spec.h"
#include "calib/report/next_report.h"
#include "tests/unit/calib/criticism/hidden.h"

namespace mgtd::calib::testing {
namespace {

HiddenRun with_gradient() {
  HiddenRun run;
  run.G_nT_per_m << 30, 8, -12, 8, -10, 5, -12, 5, -20;
  return run;
}

criticism::search::NextReport must_ask(const PoseTable& table, const std::string& a, const std::string& b) {
  auto report = criticism::search::next_of(table, {}, std::pair(a, b));
  EXPECT_TRUE(report) << (report ? "" : report.error().text());
  return report ? *std::move(report) : criticism::search::NextReport{};
}

const criticism::search::NextStep* step(const criticism::search::NextReport& report, std::string_view words) {
  const auto found =
      std::find_if(report.steps.begin(), report.steps.end(), [&](const criticism::search::NextStep& s) {
        return s.measurement.action.find(words) != std::string::npos;
      });
  return found == report.steps.end() ? nullptr : &*found;
}

/// The run cut to poses without a tilt, as a table with one axis makes it.
PoseTable level_poses(PoseTable table) {
  std::erase_if(table.poses,
                [](const Pose& p) { return std::abs(*p.pitch_rad) + std::abs(*p.roll_rad) > 0.4; });
  return table;
}

TEST(NextPair, WhatIsTheSitesStaysBehindWhereTheRigIsMoved) {
  // Barely seen, so that the pair is open; the truth is the site's, which another place does not have.
  HiddenRun run = with_gradient();
  run.G_nT_per_m *= 0.02;
  const criticism::search::NextReport site = must_ask(hidden_run(run, 3), "site.gradient", "site.dipole");
  const criticism::search::NextStep* const moved = step(site, "another place");
  ASSERT_EQ(moved, nullptr) << "both are the site's: at another place both are free again";
  const criticism::search::NextReport mixed = must_ask(hidden_run(run, 3), "site.gradient", "axis.quadratic");
  for (const criticism::search::NextStep& s : mixed.steps)
    EXPECT_GE(s.measurement.p_right_after, s.measurement.p_right_before) << s.measurement.action;
}

TEST(NextPair, AQuestionThatALaterRoundLeavesOpenIsAskedToo) {
  // The drift is sure, and comes first; what remains beside it has two names in one field strength.
  const Hidden drift_and_square = [](const Pose& pose, int i, int a, const Eigen::Vector3d& v) {
    if (i == 3 && a == 2) return 40 * *pose.t_s / 3600;
    return i == 1 && a == 0 ? 6 * std::pow(v[0] / 5e4, 2) : 0.0;
  };
  const PoseTable table = hidden_run({.hidden = drift_and_square}, 4);
  const auto explained = criticism::search::explain(table, {});
  ASSERT_TRUE(explained);
  ASSERT_EQ(explained->finding, criticism::search::Finding::ambiguous);
  ASSERT_EQ(explained->rounds.front().added.effect, "axis.offset.drift");
  ASSERT_TRUE(explained->rounds.front().possible.empty());
  ASSERT_NE(explained->open_round(), nullptr);
  ASSERT_FALSE(explained->next.empty());
  const auto next = criticism::search::next_after(*explained, table, {}, std::nullopt);
  ASSERT_TRUE(next) << next.error().text();
  EXPECT_EQ(next->effect, explained->open_round()->added.spec);
  EXPECT_NEAR(next->p_right_before, 0.5, 1e-3) << "the drift is in the model of the question";
  EXPECT_NEAR(explained->next.front().p_right_before, next->p_right_before, 1e-3);
}

/// A memory of the cores where the way of the table is not known, and what other pairs of sources have
/// besides, are no alternatives of the winner: the round alone says that they are possible.
TEST(NextPair, WhatTheRoundAloneLeavesOpenIsAsked) {
  const Hidden square = [](const Pose&, int i, int a, const Eigen::Vector3d& v) {
    return i == 1 && a == 0 ? 6 * std::pow(v[0] / 5e4, 2) : 0.0;
  };
  const PoseTable table = hidden_run({.hidden = square}, 4);
  auto explained = criticism::search::explain(table, {});
  ASSERT_TRUE(explained) << explained.error().text();
  ASSERT_FALSE(explained->rounds.empty());
  for (const char* other : {"axis.hysteresis", "site.dipole"}) {
    explained->rounds.front().possible = {other};
    const auto next = criticism::search::next_after(*explained, table, {}, std::nullopt);
    ASSERT_TRUE(next) << next.error().text();
    EXPECT_EQ(next->effect, explained->rounds.front().added.spec);
    EXPECT_EQ(effects::family_name(next->alternative), other);
  }
}

TEST(NextPair, APairThatIsAskedAboutAndTheVerdictsOwnGiveOneAnswer) {
  const Hidden square = [](const Pose&, int i, int a, const Eigen::Vector3d& v) {
    return i == 1 && a == 0 ? 6 * std::pow(v[0] / 5e4, 2) : 0.0;
  };
  const PoseTable run = hidden_run({.hidden = square}, 4);
  const auto open = criticism::search::next_of(run, {}, std::nullopt);
  ASSERT_TRUE(open);
  EXPECT_NEAR(open->p_right_before, 0.5, 1e-3) << "in one field strength their forms alone differ";
  for (const auto& [a, b] :
       {std::pair("axis.quadratic", "axis.transverse"), std::pair("axis.transverse", "axis.quadratic")}) {
    const criticism::search::NextReport asked = must_ask(run, a, b);
    EXPECT_NEAR(asked.p_right_before, 0.5, 1e-3) << a;
    ASSERT_NE(step(asked, "field a fifth weaker"), nullptr) << a;
    EXPECT_GT(step(asked, "field a fifth weaker")->measurement.p_right_after, 0.9) << a;
  }
}

TEST(NextPair, ANewTiltIsOfferedWhereTheRunIsFlat) {
  // The reading of a vertical axis hardly changes there: its offset and its scale factor drift alike.
  const Hidden drift = [](const Pose& p, int i, int a, const Eigen::Vector3d&) {
    return i == 1 && a == 2 ? 2 * *p.t_s / 3600 : 0.0;
  };
  const PoseTable flat = level_poses(hidden_run({.hidden = drift}, 5));
  const criticism::search::NextReport report = must_ask(flat, "axis.offset.drift", "axis.gain.drift");
  const criticism::search::NextStep* const tilt = step(report, "tilted");
  ASSERT_NE(tilt, nullptr) << report::to_text(report);
  EXPECT_GT(tilt->measurement.p_right_after, tilt->measurement.p_right_before);
  for (std::size_t k = 0; k < tilt->poses.size(); ++k)
    EXPECT_GT(std::abs(*tilt->poses[k].pitch_rad), to_rad(20) - 0.4) << k;
}

}  // namespace
}  // namespace mgtd::calib::testing
