// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/law_ranking.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "calib/discovery/formula_parts.h"
#include "tests/unit/calib/discovery/discovery_scene.h"

namespace mgtd::calib::discovery {
namespace {

TEST(LawRanking, AWiderFormulaMustPayForItsCoefficients) {
  EXPECT_GT(price_paid(100, 1), price_paid(104, 2));
  EXPECT_LT(price_paid(100, 1), price_paid(112, 2));
}

TEST(LawRanking, ProbabilitiesAddUpToOne) {
  std::vector<RankedLaw> laws(3);
  laws[0].score = -1000, laws[1].score = 3000, laws[2].score = 2996;
  share_probability(laws);
  EXPECT_EQ(laws.front().score, 3000);
  EXPECT_NEAR(laws[1].P / laws[0].P, std::exp(-2), 1e-12);
  EXPECT_NEAR(std::accumulate(laws.begin(), laws.end(), 0.0,
                              [](double sum, const RankedLaw& l) { return sum + l.P; }),
              1, 1e-12);
}

/// A knee between two deciles: the grid finds it, the bracket its place.
TEST(LawRanking, TheInnerNumberIsRefinedBetweenTheGrid) {
  calib::testing::HiddenRun hidden{.noise_nT = 0.05};
  hidden.hidden = [](const Pose& p, int i, int a, const Eigen::Vector3d&) {
    return i == 2 && a == 1 ? 0.2 * std::max(0.0, *p.T_degC[2] - 21.7) : 0.0;
  };
  const auto s = testing::scene(hidden, 3);
  const FormulaValues values = testing::must(FormulaValues::of(s->formulas, s->inputs));
  std::vector<RankedLaw> laws = rank_formulas(LawSearch(FormulaProducts(values, s->sums), s->sums).scores(),
                                              values, s->sums.channels());
  ASSERT_TRUE(refine_inner(laws, 30, s->formulas, s->inputs, s->sums));
  share_probability(laws);
  EXPECT_EQ(laws.front().where, "s3.y");
  const Family& family = s->formulas.families[laws.front().family];
  EXPECT_EQ(family.covariates.front(), "T_degC");
  EXPECT_NEAR(laws.front().inner, 21.7, 0.2) << family.columns(laws.front().inner).front();
  EXPECT_GT(laws.front().P, 0.5);
}

/// The larger a law, the finer its inner number must be told: otherwise what is left of it looks like more.
TEST(LawRanking, AnInnerNumberIsAsFineAsTheLawIsLarge) {
  constexpr double kPeriod_s = 701;
  calib::testing::HiddenRun hidden{.noise_nT = 0.02};
  hidden.hidden = [](const Pose& p, int i, int a, const Eigen::Vector3d&) {
    return i == 2 && a == 1 ? 40 * std::sin(2 * std::numbers::pi * *p.t_s / kPeriod_s) : 0.0;
  };
  const auto s = testing::scene(hidden, 3);
  const FormulaValues values = testing::must(FormulaValues::of(s->formulas, s->inputs));
  std::vector<RankedLaw> laws = rank_formulas(LawSearch(FormulaProducts(values, s->sums), s->sums).scores(),
                                              values, s->sums.channels());
  ASSERT_TRUE(refine_inner(laws, 3, s->formulas, s->inputs, s->sums));
  const Family& family = s->formulas.families[laws.front().family];
  ASSERT_EQ(family.inner_unit, kPeriodUnit);
  EXPECT_NEAR(laws.front().inner, kPeriod_s / 3600, 3e-6);
  const auto best = fitted_law(family.columns(kPeriod_s / 3600), laws.front().place, s->inputs, s->sums);
  ASSERT_TRUE(best);
  EXPECT_GT(laws.front().S, best->S - 1);
}

}  // namespace
}  // namespace mgtd::calib::discovery
