// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "calib/criticism/tests/score.h"

/// Families whose signatures are given as columns, without a run behind them.
namespace mgtd::calib::testing {

/// One column on one axis; several are values of a searched number.
inline std::shared_ptr<criticism::tests::CandidateEffect> candidate_of_columns(const std::string& name,
                                                                               std::size_t values) {
  auto out = std::make_shared<criticism::tests::CandidateEffect>();
  out->name = name;
  out->variants.resize(values);
  for (std::size_t v = 0; v < values; ++v) out->values.emplace_back(static_cast<double>(v));
  out->parameter = name;
  out->hypotheses.push_back(
      {.where = "s1.x", .axes = 1, .combine = Eigen::MatrixXd::Identity(1, 1), .names = {"s1.x"}});
  return out;
}

inline criticism::tests::ScoredFamily scored(
    const std::shared_ptr<criticism::tests::CandidateEffect>& candidate_effect,
    const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual) {
  criticism::tests::ScoredFamily out{.candidate_effect = candidate_effect.get(), .own = candidate_effect};
  for (Eigen::Index v = 0; v < columns.cols(); ++v) {
    out.signatures.emplace_back(Eigen::MatrixXd(columns.col(v)), residual);
    out.score_last({});
  }
  out.calibrated = out.priced;
  return out;
}

inline Eigen::VectorXd normal(Eigen::Index n, std::mt19937_64& random) {
  std::normal_distribution<double> gauss;
  return Eigen::VectorXd::NullaryExpr(n, [&] { return gauss(random); });
}

}  // namespace mgtd::calib::testing
