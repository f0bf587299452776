// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/whitener.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "calib/linear/qr.h"

namespace mgtd::calib {
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

std::vector<Eigen::Index> order_in_time(const JointProblem& problem) {
  std::vector<Eigen::Index> order(problem.poses.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return problem.poses[static_cast<std::size_t>(a)].t_h < problem.poses[static_cast<std::size_t>(b)].t_h;
  });
  return order;
}

Whitener::Whitener(const JointProblem& problem, const Eigen::MatrixXd& nuisance, double rho,
                   const WanderingRates& nT_per_sqrt_h)
    : rho_(rho), order_(order_in_time(problem)), steps_(order_.size()) {
  for (int c = 0; c < kChannels; ++c)
    if (nT_per_sqrt_h[c] > 0) walking_.push_back(c);
  const auto W = static_cast<Eigen::Index>(walking_.size()), U = unknowns();
  const double fresh = 1 / std::sqrt(1 - rho * rho);
  /// What the readings of a pose, each times a factor, feel of its unknowns.
  const auto felt = [&](Eigen::Index pose, const Eigen::Matrix<double, kChannels, 1>& factor) {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(kChannels, U);
    for (Eigen::Index i = 0; i < W; ++i) {
      const int c = walking_[static_cast<std::size_t>(i)];
      out(c, i) = factor[c] * problem.poses[static_cast<std::size_t>(pose)].weight[c];
    }
    out.rightCols<kNuisances>() = factor.asDiagonal() * nuisance.middleRows<kChannels>(pose * kPoseRows);
    return out;
  };
  Eigen::MatrixXd carried = Eigen::MatrixXd::Zero(U, U);
  for (std::size_t k = 0; k < order_.size(); ++k) {
    Step& step = steps_[k];
    const auto& pose = problem.poses[static_cast<std::size_t>(order_[k])];
    step.now.setOnes();
    step.before.setZero();
    Eigen::MatrixXd last = Eigen::MatrixXd::Zero(U + W + kChannels, U), mine = last;
    last.topRows(U) = carried;
    if (k > 0) {
      const auto& previous = problem.poses[static_cast<std::size_t>(order_[k - 1])];
      if (rho != 0) {
        const auto both = (pose.weight.array() > 0 && previous.weight.array() > 0).cast<double>();
        step.now = 1 + both * (fresh - 1);
        step.before = -rho * fresh * both;
        last.bottomRows<kChannels>() = felt(order_[k - 1], step.before);
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
    mine.bottomRows<kChannels>() = felt(order_[k], step.now);
    step.first = triangularising_rotation(last);
    if (k > 0) log_det_ += log_det_of(step.first * last);
    Eigen::MatrixXd left = Eigen::MatrixXd::Zero(W + kChannels + kNuisances, U);
    left.topRows(W + kChannels) = (step.first * mine).bottomRows(W + kChannels);
    left.bottomRightCorner<kNuisances, kNuisances>() =
        nuisance.middleRows<kNuisances>(order_[k] * kPoseRows + kChannels);
    step.second = triangularising_rotation(left);
    carried = (step.second * left).topRows(U);
    if (k + 1 == order_.size()) log_det_ += log_det_of(carried);
    rank_ += static_cast<int>((pose.weight.array() > 0).count()) - (pose.f_weight > 0 ? 0 : 1);
  }
}

Eigen::MatrixXd Whitener::apply(const Eigen::MatrixXd& rows) const {
  const Eigen::Index n = rows.cols(), U = unknowns(), W = U - kNuisances;
  Eigen::MatrixXd out(static_cast<Eigen::Index>(order_.size()) * kChannels, n);
  Eigen::MatrixXd in = Eigen::MatrixXd::Zero(U + W + kChannels, n), turned(in.rows(), n);
  Eigen::MatrixXd left(W + kPoseRows, n), emitted(W + kPoseRows, n);
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const Step& step = steps_[k];
    const Eigen::Index row = order_[k] * kPoseRows;
    in.middleRows(U, W).setZero();
    in.bottomRows<kChannels>() = step.now.asDiagonal() * rows.middleRows<kChannels>(row);
    if (k > 0 && rho_ != 0) {
      in.bottomRows<kChannels>() +=
          step.before.asDiagonal() * rows.middleRows<kChannels>(order_[k - 1] * kPoseRows);
    }
    turned.noalias() = step.first * in;
    left.topRows(W + kChannels) = turned.bottomRows(W + kChannels);
    left.bottomRows<kNuisances>() = rows.middleRows<kNuisances>(row + kChannels);
    emitted.noalias() = step.second * left;
    in.topRows(U) = emitted.topRows(U);
    out.middleRows<kChannels>(order_[k] * kChannels) = emitted.bottomRows<kChannels>();
  }
  return out;
}

}  // namespace mgtd::calib
