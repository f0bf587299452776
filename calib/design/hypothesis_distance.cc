// SPDX-License-Identifier: Apache-2.0
#include "calib/design/hypothesis_distance.h"

#include <algorithm>
#include <numeric>

#include "calib/criticism/tests/alternatives.h"
#include "calib/linear/ldlt.h"
#include "calib/linear/qr.h"

namespace mgtd::calib::design {
namespace {

/// (A'A)^-1, a little of the diagonal added: a direction that nothing determines stays where it is.
Eigen::MatrixXd inverse_of_products(const Eigen::MatrixXd& A) {
  constexpr double kRidge = 1e-9;
  return linear::solve_by_scaled_ldlt(A.transpose() * A, Eigen::MatrixXd::Identity(A.cols(), A.cols()),
                                      kRidge);
}

}  // namespace

double still_open(const HypothesisPair& pair, double lambda) {
  return pair.weight * (1 - criticism::tests::probability_right(lambda));
}

HypothesisDistance::HypothesisDistance(const Eigen::MatrixXd& rows, Eigen::Index fixed,
                                       std::vector<Described> described,
                                       const std::vector<HypothesisPair>& pairs)
    : fixed_(fixed), described_(std::move(described)) {
  for (const HypothesisPair& pair : pairs) {
    const Eigen::MatrixXd other = columns_of(pair.other, rows);
    const Eigen::VectorXd v = signature_of(pair.truth, rows);
    State state{.pair = pair, .x = linear::least_squares(other, v), .K = inverse_of_products(other)};
    state.lambda = (v - other * state.x).squaredNorm();
    pairs_.push_back(std::move(state));
  }
}

Eigen::MatrixXd HypothesisDistance::columns_of(std::size_t other, const Eigen::MatrixXd& rows) const {
  const Described& own = described_[other];
  Eigen::MatrixXd out(rows.rows(), fixed_ + own.count);
  out << rows.leftCols(fixed_), rows.middleCols(own.first, own.count);
  return out;
}

Eigen::VectorXd HypothesisDistance::signature_of(std::size_t truth, const Eigen::MatrixXd& rows) const {
  const Described& own = described_[truth];
  return rows.middleCols(own.first, own.count) * own.size;
}

std::vector<std::size_t> HypothesisDistance::worst_first() const {
  std::vector<std::size_t> out(pairs_.size());
  std::iota(out.begin(), out.end(), std::size_t{0});
  const auto open = [this](std::size_t i) { return still_open(pairs_[i].pair, pairs_[i].lambda); };
  std::stable_sort(out.begin(), out.end(), [&](std::size_t a, std::size_t b) { return open(a) > open(b); });
  return out;
}

HypothesisDistance::Innovation HypothesisDistance::innovation(const State& state,
                                                              const Eigen::MatrixXd& rows) const {
  Innovation out{.columns = columns_of(state.pair.other, rows), .e = {}, .S = {}};
  out.e = signature_of(state.pair.truth, rows) - out.columns * state.x;
  out.S = out.columns * state.K * out.columns.transpose();
  out.S.diagonal().array() += 1;
  return out;
}

double HypothesisDistance::gain(std::size_t pair, const Eigen::MatrixXd& rows) const {
  const Innovation now = innovation(pairs_[pair], rows);
  return now.e.dot(linear::solve_by_ldlt(now.S, now.e));
}

void HypothesisDistance::add(const Eigen::MatrixXd& rows) {
  for (State& state : pairs_) {
    const Innovation now = innovation(state, rows);
    const Eigen::VectorXd whitened = linear::solve_by_ldlt(now.S, now.e);
    const Eigen::MatrixXd turned = now.columns * state.K;
    state.lambda += now.e.dot(whitened);
    state.x += turned.transpose() * whitened;
    state.K -= turned.transpose() * linear::solve_by_ldlt(now.S, turned);
  }
}

std::size_t best_of(const HypothesisDistance& distance, const std::vector<PossiblePose>& group) {
  constexpr double kNothing = 1e-6;
  for (const std::size_t pair : distance.worst_first()) {
    std::size_t best = 0;
    double most = 0;
    for (std::size_t m = 0; m < group.size(); ++m) {
      const double a_minute = distance.gain(pair, group[m].rows) / group[m].minutes;
      if (a_minute > most) most = a_minute, best = m;
    }
    if (most > kNothing) return best;
  }
  return 0;
}

std::vector<std::size_t> placed(HypothesisDistance distance,
                                const std::vector<std::vector<PossiblePose>>& groups) {
  std::vector<std::size_t> out;
  for (const std::vector<PossiblePose>& group : groups) {
    out.push_back(best_of(distance, group));
    distance.add(group[out.back()].rows);
  }
  return out;
}

}  // namespace mgtd::calib::design
