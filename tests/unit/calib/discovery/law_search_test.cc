// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/law_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "calib/discovery/fitted_law.h"
#include "calib/stats/chi_square.h"
#include "tests/unit/calib/discovery/discovery_scene.h"

namespace mgtd::calib::discovery {
namespace {

/// The score of the search is the fall that the fitted formula has, at every kind of place.
TEST(LawSearch, ScoresAreThoseOfTheFittedFormulas) {
  const auto s = testing::scene({}, 8);
  const FormulaValues values = testing::must(FormulaValues::of(s->formulas, s->inputs));
  const std::vector<Tried> tried = LawSearch(FormulaProducts(values, s->sums), s->sums).scores();
  EXPECT_GT(tried.size(), 15'000U);
  std::set<Place::Kind> kinds;
  for (std::size_t i = 0; i < tried.size(); i += 397) {
    const FormulaValues::Member& m = values.members()[tried[i].member];
    const Family& family = s->formulas.families[m.family];
    const FittedLaw fitted =
        testing::must(fitted_law(family.columns(family.inner[m.inner]), tried[i].place, s->inputs, s->sums));
    EXPECT_EQ(fitted.k, tried[i].k);
    EXPECT_NEAR(fitted.S, tried[i].S, 1e-6 * (1 + fitted.S));
    kinds.insert(tried[i].place.kind);
  }
  EXPECT_EQ(kinds.size(), 4U);
}

TEST(LawSearch, WhatTheCalibrationTakesUpIsNotAsked) {
  const auto s = testing::scene({}, 8);
  for (const char* linear : {"(u/50000)", "(ux/50000)", "2", "(s3_x_nT/50000)"}) {
    const FittedLaw fitted = testing::must(fitted_law({linear}, {Place::Kind::axis, 4}, s->inputs, s->sums));
    EXPECT_EQ(fitted.k, 0) << linear;
  }
  EXPECT_EQ(testing::must(fitted_law({"(u/50000)^2"}, {Place::Kind::axis, 4}, s->inputs, s->sums)).k, 1);
}

/// Of white noise S of one coefficient is chi-square: the largest of many draws lies where its tail does.
TEST(LawSearch, TheLargestOfNoiseIsThatOfSomeThousandIndependentQuestions) {
  const auto s = testing::scene({}, 9);
  const FormulaValues values = testing::must(FormulaValues::of(s->formulas, s->inputs));
  const LawSearch search(FormulaProducts(values, s->sums), s->sums);
  std::mt19937_64 random(2);
  const std::vector<LawSearch::Largest> all =
      search.largest(s->sums.scores_of(s->sums.noise(300, random)), search.unit_columns());
  const auto one_coefficient = std::find_if(all.begin(), all.end(), [](const LawSearch::Largest& largest) {
    return largest.kind == Place::Kind::axis && largest.k == 1;
  });
  ASSERT_NE(one_coefficient, all.end());
  double p = 0;
  for (const float S : one_coefficient->S) p += stats::chi_square_p(static_cast<double>(S), 1);
  const double questions = static_cast<double>(one_coefficient->S.size()) / p;
  EXPECT_GT(questions, 1000);
  EXPECT_LT(questions, 12'000);
}

}  // namespace
}  // namespace mgtd::calib::discovery
