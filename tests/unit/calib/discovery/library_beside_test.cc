// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/library_beside.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calib/effects/library/library.h"
#include "tests/unit/calib/discovery/discovery_scene.h"

namespace mgtd::calib::discovery {
namespace {

namespace tests = criticism::tests;

/// A step in time and a temperature on one axis: one takes a part of the other.
double two_laws(const Pose& pose, int sensor, int axis, const Eigen::Vector3d&) {
  if (sensor != 1 || axis != 2) return 0;
  return 0.3 * (*pose.T_degC[1] - 21) + (*pose.t_s > 1500 ? 0.5 : 0);
}

class LibraryBeside : public ::testing::Test {
 protected:
  std::unique_ptr<testing::Scene> scene_ = testing::scene({.noise_nT = 0.05, .hidden = two_laws}, 3);
  FormulaValues values_ = testing::must(FormulaValues::of(scene_->formulas, scene_->inputs));
  FormulaProducts products_{values_, scene_->sums};
  tests::CandidateEffects candidates_ = tests::library_candidates(scene_->table);
  Place place_{Place::Kind::axis, 5};

  [[nodiscard]] Workbench bench() {
    std::vector<tests::ScoredFamily> library;
    for (const tests::CandidateEffect& candidate : candidates_.testable)
      if (candidate.name == "axis.offset.temperature")
        library.push_back(
            tests::score_family(scene_->fit.problem, scene_->fit.state, scene_->residual, {}, candidate));
    return {.grammar = scene_->formulas,
            .inputs = scene_->inputs,
            .products = products_,
            .problem = scene_->fit.problem,
            .residual = scene_->residual,
            .noise = {},
            .library = std::move(library)};
  }
  /// Of the family's score on s2.z; nothing where it has none.
  [[nodiscard]] static std::optional<double> S_on_axis(const tests::ScoredFamily& family) {
    for (const tests::Score& score : family.scores)
      if (family.candidate_effect->hypotheses[score.hypothesis].where == "s2.z") return score.S;
    return std::nullopt;
  }
  [[nodiscard]] FittedLaw law_of(const Columns& columns, const ChannelSums& sums) {
    return testing::must(fitted_law(columns, place_, scene_->inputs, sums));
  }
  [[nodiscard]] Eigen::MatrixXd of_gradient() const {
    return gradient_rows(scene_->fit.problem, scene_->fit.state);
  }
};

TEST_F(LibraryBeside, NoLawChangesNothing) {
  const Workbench b = bench();
  const auto beside = library_beside(b, {}, of_gradient());
  ASSERT_EQ(beside.size(), 1U);
  ASSERT_EQ(beside.front().scores.size(), b.library.front().scores.size());
  for (std::size_t i = 0; i < beside.front().scores.size(); ++i) {
    EXPECT_EQ(beside.front().scores[i].k, b.library.front().scores[i].k);
    EXPECT_NEAR(beside.front().scores[i].S, b.library.front().scores[i].S,
                1e-6 * (1 + b.library.front().scores[i].S));
  }
}

/// The same law, once as an effect and once as a formula, falls as far beside a third.
TEST_F(LibraryBeside, AnEffectFallsAsFarAsItsFormula) {
  const Workbench b = bench();
  const FittedLaw step = law_of({"(t_h>0.42)"}, scene_->sums);
  ChannelSums left = scene_->sums;
  take_out(step, left);
  const double bare = law_of({"T_degC"}, scene_->sums).S, beside = law_of({"T_degC"}, left).S;
  EXPECT_GT(std::abs(bare - beside), 0.02 * bare) << "the laws must share something";
  EXPECT_NEAR(S_on_axis(b.library.front()).value(), bare, 1e-4 * bare);
  EXPECT_NEAR(S_on_axis(library_beside(b, {&step}, of_gradient()).front()).value(), beside, 1e-4 * beside);
}

TEST_F(LibraryBeside, WhatALawIsItselfHasNoScore) {
  const Workbench b = bench();
  const FittedLaw same = law_of({"T_degC"}, scene_->sums);
  EXPECT_FALSE(S_on_axis(library_beside(b, {&same}, of_gradient()).front()));
}

}  // namespace
}  // namespace mgtd::calib::discovery
