// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/heavy_tails.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "calib/criticism/tests/criticism.h"
#include "tests/unit/calib/criticism/hidden.h"

namespace mgtd::calib::criticism::tests {
namespace {

using testing::hidden_run;
using testing::HiddenRun;

/// Of the law of the offsets' drift, on all axes.
struct Drift {
  double score{0};
  TailsBeside tails;
};

Drift drift_in(const PoseTable& table) {
  const auto fit = fit::joint::fit_joint(table, {.most_left_out = 0});
  if (!fit) throw std::runtime_error(fit.error().text());
  const CandidateEffects candidates{
      {testing::candidate_effect("offset.drift", [](const Pose&, double t_h, int, double) { return t_h; })},
      {}};
  const Criticism c = criticise(*fit, candidates, 1);
  return {c.families.front().winner().S, tails_beside(c.families.front(), c.residual)};
}

/// The scatter of 157 poses tells a variance to a ninth.
TEST(HeavyTails, NormalNoiseScattersAsItsChiSquareSays) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Drift none = drift_in(hidden_run({}, seed));
    EXPECT_NEAR(none.tails.excess_kurtosis, 0, 0.4);
    EXPECT_NEAR(none.tails.score_by_scatter, none.score, 0.4 * none.score);
    const HiddenRun drifting{.hidden = [](const Pose& p, int i, int a, const Eigen::Vector3d&) {
      return i == 1 && a == 2 ? 1.5 * *p.t_s / 3600 : 0.0;
    }};
    const Drift found = drift_in(hidden_run(drifting, seed));
    EXPECT_NEAR(found.tails.excess_kurtosis, 0, 0.4) << "the law is out of what is left";
    EXPECT_NEAR(found.tails.score_by_scatter, found.score, 0.4 * found.score);
  }
}

TEST(HeavyTails, AreSeenInWhatIsLeft) {
  for (const std::uint64_t seed : {1U, 2U, 3U})
    EXPECT_GT(drift_in(hidden_run({.tail = testing::Tail::student3}, seed)).tails.excess_kurtosis, 0.5)
        << seed;
}

/// The last pose is off by twelve standard deviations: most of what looks like a drift is its own.
TEST(HeavyTails, WhatOnePoseSaysCountsForLittle) {
  HiddenRun run;
  run.hidden = [n = run.noise_nT](const Pose& p, int i, int a, const Eigen::Vector3d&) {
    return i == 1 && a == 2 && p.number == 157 ? 12 * n : 0.0;
  };
  const Drift one = drift_in(hidden_run(run, 4));
  EXPECT_GT(one.tails.excess_kurtosis, 0.5);
  EXPECT_LT(one.tails.score_by_scatter, 0.6 * one.score);
}

}  // namespace
}  // namespace mgtd::calib::criticism::tests
