// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/whitener.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "calib/linear/qr.h"

namespace mgtd::calib::criticism::tests {
namespace {

/// A walk begins at nothing, because the offset of the model is free.
constexpr double kStart_nT = 1e-4;
/// Of a step between two poses at one time.
constexpr double kLeastStep_nT = 1e-6;

/// ln det T'T of the triangle at the top.
double log_det_of(const Eigen::MatrixXd& triangle) {
  double out = 0;
  for (Eigen::Index i = 0; i < triangle.cols(); ++i)
    if (triangle(i, i) != 0) out += 2 * std::log(std::abs(triangle(i, i)));
  return out;
}

}  // namespace

std::vector<Eigen::Index> order_in_time(const fit::joint::JointProblem& problem) {
  std::vector<Eigen::Index> order(problem.poses.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return problem.poses[static_cast<std::size_t>(a)].t_h < problem.poses[static_cast<std::size_t>(b)].t_h;
  });
  return order;
}

Whitener::Whitener(const fit::joint::JointProblem& problem, const Eigen::MatrixXd& nuisance, double rho,
                   const fit::joint::WanderingRates& nT_per_sqrt_h)
    : rho_(rho), order_(order_in_time(problem)), steps_(order_.size()) {
  for (int c = 0; c < sensor::kChannels; ++c)
    if (nT_per_sqrt_h[c] > 0) walking_.push_back(c);
  const auto W = static_cast<Eigen::Index>(walking_.size()), U = unknowns();
  const double fresh = 1 / std::sqrt(1 - rho * rho);
  /// What the readings of a pose, each times a factor, feel of its unknowns.
  const auto felt = [&](Eigen::Index pose, const Eigen::Matrix<double, sensor::kChannels, 1>& factor) {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(sensor::kChannels, U);
    for (Eigen::Index i = 0; i < W; ++i) {
      const int c = walking_[static_cast<std::size_t>(i)];
      out(c, i) = factor[c] * problem.poses[static_cast<std::size_t>(pose)].weight[c];
    }
    out.rightCols<fit::joint::kNuisances>() =
        factor.asDiagonal() * nuisance.middleRows<sensor::kChannels>(pose * kPoseRows);
    return out;
  };
  Eigen::MatrixXd carried = Eigen::MatrixXd::Zero(U, U);
  for (std::size_t k = 0; k < order_.size(); ++k) {
    Step& step = steps_[k];
    const auto& pose = problem.poses[static_cast<std::size_t>(order_[k])];
    step.now.setOnes();
    step.before.setZero();
    Eigen::MatrixXd last = Eigen::MatrixXd::Zero(U + W + sensor::kChannels, U), mine = last;
    last.topRows(U) = carried;
    if (k > 0) {
      const auto& previous = problem.poses[static_cast<std::size_t>(order_[k - 1])];
      if (rho != 0) {
        const auto both = (pose.weight.array() > 0 && previous.weight.array() > 0).cast<double>();
        step.now = 1 + both * (fresh - 1);
        step.before = -rho * fresh * both;
        last.bottomRows<sensor::kChannels>() = felt(order_[k - 1], step.before);
      }
      const double root_h = std::sqrt(std::max(0.0, pose.t_h - previous.t_h));
      for (Eigen::Index i = 0; i < W; ++i) {
        const double step_nT = nT_per_sqrt_h[walking_[static_cast<std::size_t>(i)]] * root_h;
        mine(U + i, i) = 1 / std::max(step_nT, kLeastStep_nT);
        last(U + i, i) = -mine(U + i, i);
        log_det_ -= 2 * std::log(mine(U + i, i));
      }
    } else {
      for (Eigen::Index i = 0; i < W; ++i) mine(U + i, i) = 1 / kStart_nT;
    }
    mine.bottomRows<sensor::kChannels>() = felt(order_[k], step.now);
    step.first = linear::triangularising_rotation(last);
    if (k > 0) log_det_ += log_det_of(step.first * last);
    Eigen::MatrixXd left = Eigen::MatrixXd::Zero(W + sensor::kChannels + fit::joint::kNuisances, U);
    left.topRows(W + sensor::kChannels) = (step.first * mine).bottomRows(W + sensor::kChannels);
    left.bottomRightCorner<fit::joint::kNuisances, fit::joint::kNuisances>() =
        nuisance.middleRows<fit::joint::kNuisances>(order_[k] * kPoseRows + sensor::kChannels);
    step.second = linear::triangularising_rotation(left);
    carried = (step.second * left).topRows(U);
    if (k + 1 == order_.size()) log_det_ += log_det_of(carried);
    rank_ += static_cast<int>((pose.weight.array() > 0).count()) - (pose.f_weight > 0 ? 0 : 1);
  }
}

Eigen::MatrixXd Whitener::apply(const Eigen::MatrixXd& rows) const {
  const Eigen::Index n = rows.cols(), U = unknowns(), W = U - fit::joint::kNuisances;
  Eigen::MatrixXd out(static_cast<Eigen::Index>(order_.size()) * sensor::kChannels, n);
  Eigen::MatrixXd in = Eigen::MatrixXd::Zero(U + W + sensor::kChannels, n), turned(in.rows(), n);
  Eigen::MatrixXd left(W + kPoseRows, n), emitted(W + kPoseRows, n);
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const Step& step = steps_[k];
    const Eigen::Index row = order_[k] * kPoseRows;
    in.middleRows(U, W).setZero();
    in.bottomRows<sensor::kChannels>() = step.now.asDiagonal() * rows.middleRows<sensor::kChannels>(row);
    if (k > 0 && rho_ != 0) {
      in.bottomRows<sensor::kChannels>() +=
          step.before.asDiagonal() * rows.middleRows<sensor::kChannels>(order_[k - 1] * kPoseRows);
    }
    turned.noalias() = step.first * in;
    left.topRows(W + sensor::kChannels) = turned.bottomRows(W + sensor::kChannels);
    left.bottomRows<fit::joint::kNuisances>() =
        rows.middleRows<fit::joint::kNuisances>(row + sensor::kChannels);
    emitted.noalias() = step.second * left;
    in.topRows(U) = emitted.topRows(U);
    out.middleRows<sensor::kChannels>(order_[k] * sensor::kChannels) =
        emitted.bottomRows<sensor::kChannels>();
  }
  return out;
}

}  // namespace mgtd::calib::criticism::tests
