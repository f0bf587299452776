// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/multiplicity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/unit/calib/criticism/synthetic_families.h"

namespace mgtd::calib::testing {
namespace {

constexpr Eigen::Index kRows = 60;

/// A step at every other row, unit length, without its mean.
Eigen::MatrixXd steps() {
  Eigen::MatrixXd out(kRows, kRows / 2 - 1);
  for (Eigen::Index v = 0; v < out.cols(); ++v) {
    Eigen::VectorXd z = Eigen::VectorXd::Zero(kRows);
    z.tail(kRows - 2 * (v + 1)).setOnes();
    z.array() -= z.mean();
    out.col(v) = z.normalized();
  }
  return out;
}

// Nothing is there: the smallest p of all, its search counted, must be uniform where alarms are raised.
TEST(Null, TheSearchOverANumberIsCounted) {
  std::mt19937_64 random(3);
  std::vector<std::shared_ptr<criticism::tests::CandidateEffect>> candidate_effects;
  std::vector<Eigen::MatrixXd> columns;
  for (int i = 0; i < 5; ++i) {
    candidate_effects.push_back(candidate_of_columns("law", 1));
    columns.emplace_back(normal(kRows, random));
  }
  columns.push_back(steps());
  candidate_effects.push_back(candidate_of_columns("step", static_cast<std::size_t>(columns.back().cols())));
  const auto ask = [&] {
    const Eigen::VectorXd residual = normal(kRows, random);
    std::vector<criticism::tests::ScoredFamily> out;
    for (std::size_t f = 0; f < columns.size(); ++f)
      out.push_back(scored(candidate_effects[f], columns[f], residual));
    return out;
  };
  auto families = ask();
  const criticism::tests::Rates rates = criticism::tests::draw_rates(families, 11);
  ASSERT_TRUE(criticism::tests::calibrate(families, rates));
  std::vector<double> asked;
  for (const criticism::tests::ScoredFamily& f : families) asked.push_back(f.asked);
  EXPECT_NEAR(asked.front(), 1, 0.15);  // one question; its rate comes from a third of 1000 draws: 5.5 %
  EXPECT_GT(asked.back(), 4);           // 29 instants, neighbours alike
  EXPECT_LT(asked.back(), 20);
  constexpr int kRuns = 4000;
  int step_alarms = 0, alarms = 0;
  for (int i = 0; i < kRuns; ++i) {
    const auto run = ask();
    double smallest = 0;
    for (std::size_t f = 0; f < run.size(); ++f)
      smallest = std::min(smallest, criticism::tests::best_of(std::min(0.0, run[f].priced), asked[f]));
    step_alarms +=
        criticism::tests::best_of(std::min(0.0, run.back().priced), asked.back()) < std::log10(0.05) ? 1 : 0;
    alarms += criticism::tests::best_of(smallest, rates.best) < std::log10(0.05) ? 1 : 0;
  }
  // 200 expected; 14 one standard deviation of the count, 11 and 16 those of one and two estimated rates.
  EXPECT_NEAR(step_alarms, 200, 54);
  EXPECT_NEAR(alarms, 200, 64);
}

}  // namespace
}  // namespace mgtd::calib::testing
