// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/alternatives.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/unit/calib/criticism/synthetic_families.h"

namespace mgtd::calib::testing {
namespace {

constexpr Eigen::Index kRows = 40;
constexpr int kAlternatives = 8;

/// Law 0 and others that share `alike` of its signature (not in squares), each in a direction of its own.
struct Laws {
  std::vector<std::shared_ptr<criticism::tests::CandidateEffect>> candidate_effects;
  std::vector<Eigen::VectorXd> columns;

  explicit Laws(double alike) {
    for (int i = 0; i <= kAlternatives; ++i) {
      candidate_effects.push_back(candidate_of_columns("law " + std::to_string(i), 1));
      columns.push_back(Eigen::VectorXd::Zero(kRows));
      columns.back()[0] = i == 0 ? 1 : alike;
      if (i > 0) columns.back()[i] = std::sqrt(1 - alike * alike);
    }
  }

  [[nodiscard]] std::vector<criticism::tests::ScoredFamily> scored_on(const Eigen::VectorXd& residual) const {
    std::vector<criticism::tests::ScoredFamily> out;
    for (std::size_t i = 0; i < columns.size(); ++i)
      out.push_back(scored(candidate_effects[i], columns[i], residual));
    std::stable_sort(out.begin(), out.end(),
                     [](const criticism::tests::ScoredFamily& a, const criticism::tests::ScoredFamily& b) {
                       return a.calibrated < b.calibrated;
                     });
    return out;
  }
};

struct Counts {
  int first{0}, in_set{0}, alone{0};
};

/// Law 0 is there with size d.
Counts ask(const Laws& laws, double d, int runs) {
  std::mt19937_64 random(7);
  Counts out;
  for (int i = 0; i < runs; ++i) {
    const auto families = laws.scored_on(d * laws.columns[0] + normal(kRows, random));
    const auto alternatives = criticism::tests::alternatives_of(families, 0, static_cast<std::uint64_t>(i));
    bool named = families.front().candidate_effect->name == "law 0";
    out.first += named ? 1 : 0;
    int possible = 0;
    for (const criticism::tests::Alternative& r : alternatives) {
      named = named || (r.possible && r.effect == "law 0");
      possible += r.possible ? 1 : 0;
    }
    out.in_set += named ? 1 : 0;
    out.alone += possible == 0 ? 1 : 0;
  }
  return out;
}

TEST(Alternatives, AmongManyTheTrueNameIsLostOnceInTwoHundred) {
  constexpr int kRuns = 1500;
  const Counts seen = ask(Laws(0.85), 7, kRuns);
  // The limit and three standard deviations of the count: 7.5 + 3 sqrt(7.5).
  EXPECT_LE(kRuns - seen.in_set, 15);
  // And not because everything stays possible: the eight win together in one run of eight or so.
  EXPECT_LT(seen.first, kRuns - 30);
}

TEST(Alternatives, AtASizeThatTellsThemApartOneNameIsLeft) {
  constexpr int kRuns = 200;
  const Counts seen = ask(Laws(0.85), 15, kRuns);
  EXPECT_EQ(seen.first, kRuns);
  EXPECT_GE(seen.alone, kRuns * 9 / 10);
}

TEST(Alternatives, LawsThatDifferInTheirFormOnlyStayTogetherAtAnySize) {
  constexpr int kRuns = 20;
  const Counts seen = ask(Laws(0.99), 200, kRuns);
  EXPECT_EQ(seen.alone, 0);
  EXPECT_EQ(seen.in_set, kRuns);
}

bool any_possible(const std::vector<criticism::tests::Alternative>& alternatives) {
  return std::any_of(alternatives.begin(), alternatives.end(),
                     [](const criticism::tests::Alternative& a) { return a.possible; });
}

/// A law of `k` coefficients, one for each of the first rows.
criticism::tests::ScoredFamily of_rows(const std::string& name, int k, const Eigen::VectorXd& residual) {
  const auto candidate = candidate_of_columns(name, 1);
  candidate->hypotheses.front().combine = Eigen::MatrixXd::Identity(k, k);
  criticism::tests::ScoredFamily out{.candidate_effect = candidate.get(), .own = candidate};
  out.signatures.emplace_back(Eigen::MatrixXd::Identity(kRows, k), residual);
  out.score_last({});
  out.calibrated = out.priced;
  return out;
}

/// That many free coefficients come to do just what one does: by chance they hardly would.
TEST(Alternatives, ManyCoefficientsMoreAreNoMatterOfForm) {
  const Eigen::VectorXd residual = 200 * Eigen::VectorXd::Unit(kRows, 0);
  for (const int more : {1, 2, 3, 6}) {
    const auto alternatives = criticism::tests::alternatives_of(
        {of_rows("of one", 1, residual), of_rows("of many", 1 + more, residual)}, 0, 1);
    EXPECT_EQ(any_possible(alternatives), more < 3) << more;
  }
}

/// The winner holds all of the other law and a second dependence, which the other cannot make.
TEST(Alternatives, WhatTheWinnerHasBeyondTheFormDecides) {
  constexpr double kSize = 200;
  const auto possible = [&](double second) {
    const Eigen::VectorXd first = Eigen::VectorXd::Unit(kRows, 0);
    const Eigen::VectorXd residual = kSize * first + second * Eigen::VectorXd::Unit(kRows, 1);
    const std::vector<criticism::tests::ScoredFamily> families{
        of_rows("of two", 2, residual), scored(candidate_of_columns("of one", 1), first, residual)};
    const auto alternatives = criticism::tests::alternatives_of(families, 0, 1);
    return any_possible(alternatives);
  };
  EXPECT_TRUE(possible(0.1 * kSize)) << "a hundredth of the signature, in squares";
  EXPECT_FALSE(possible(0.35 * kSize)) << "an eighth";
}

TEST(Alternatives, LawsThatReadDifferentThingsAreDecidedByWhatWasMeasured) {
  constexpr int kRuns = 20;
  Laws laws(0.99);
  for (std::size_t i = 1; i < laws.candidate_effects.size(); ++i) laws.candidate_effects[i]->reads = "t_s";
  const Counts seen = ask(laws, 200, kRuns);
  EXPECT_EQ(seen.first, kRuns);
  EXPECT_EQ(seen.alone, kRuns);
}

TEST(Alternatives, FormAloneTellsNothingApart) {
  EXPECT_EQ(criticism::tests::beyond_form(40, 1600), 0);
  EXPECT_DOUBLE_EQ(criticism::tests::beyond_form(400, 1600), 320);
  EXPECT_DOUBLE_EQ(criticism::tests::probability_right(0), 0.5);
}

}  // namespace
}  // namespace mgtd::calib::testing
