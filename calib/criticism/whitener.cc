// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/whitener.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace mgtd::calib {
namespace {

using Block = Eigen::Matrix<double, kPoseRows, kNuisances>;

/// Q' of a QR: the first four rows of Q' X hold the triangle, the others are free of the four columns.
Eigen::Matrix<double, kPoseRows, kPoseRows> rotation(const Block& columns) {
  const Eigen::HouseholderQR<Block> qr(columns);
  return Eigen::Matrix<double, kPoseRows, kPoseRows>(qr.householderQ()).transpose();
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

Whitener::Whitener(const JointProblem& problem, const Eigen::MatrixXd& nuisance, double rho)
    : rho_(rho), order_(order_in_time(problem)), steps_(order_.size()) {
  Eigen::Matrix<double, kNuisances, kNuisances> carried = Eigen::Matrix4d::Zero();
  const double fresh = 1 / std::sqrt(1 - rho * rho);
  for (std::size_t k = 0; k < order_.size(); ++k) {
    Step& step = steps_[k];
    const auto& pose = problem.poses[static_cast<std::size_t>(order_[k])];
    const auto own = nuisance.middleRows<kPoseRows>(order_[k] * kPoseRows);
    step.now.setOnes();
    step.before.setZero();
    Block last = Block::Zero(), mine = Block::Zero();
    last.topRows<kNuisances>() = carried;
    if (k > 0 && rho != 0) {
      const auto& previous = problem.poses[static_cast<std::size_t>(order_[k - 1])];
      const auto both = (pose.weight.array() > 0 && previous.weight.array() > 0).cast<double>();
      step.now = 1 + both * (fresh - 1);
      step.before = -rho * fresh * both;
      last.bottomRows<kChannels>() =
          step.before.asDiagonal() * nuisance.middleRows<kChannels>(order_[k - 1] * kPoseRows);
    }
    mine.bottomRows<kChannels>() = step.now.asDiagonal() * own.topRows<kChannels>();
    step.first = rotation(last);
    Block left;
    left.topRows<kChannels>() = (step.first * mine).bottomRows<kChannels>();
    left.bottomRows<kNuisances>() = own.bottomRows<kNuisances>();
    step.second = rotation(left);
    carried = (step.second * left).topRows<kNuisances>();
    rank_ += static_cast<int>((pose.weight.array() > 0).count()) - (pose.f_weight > 0 ? 0 : 1);
  }
}

Eigen::MatrixXd Whitener::apply(const Eigen::MatrixXd& rows) const {
  const Eigen::Index n = rows.cols();
  Eigen::MatrixXd out(static_cast<Eigen::Index>(order_.size()) * kChannels, n);
  Eigen::MatrixXd carried = Eigen::MatrixXd::Zero(kNuisances, n), in(kPoseRows, n), turned(kPoseRows, n);
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const Step& step = steps_[k];
    const Eigen::Index row = order_[k] * kPoseRows;
    in.topRows<kNuisances>() = carried;
    in.bottomRows<kChannels>() = step.now.asDiagonal() * rows.middleRows<kChannels>(row);
    if (k > 0 && rho_ != 0) {
      in.bottomRows<kChannels>() +=
          step.before.asDiagonal() * rows.middleRows<kChannels>(order_[k - 1] * kPoseRows);
    }
    turned.noalias() = step.first * in;
    in.topRows<kChannels>() = turned.bottomRows<kChannels>();
    in.bottomRows<kNuisances>() = rows.middleRows<kNuisances>(row + kChannels);
    turned.noalias() = step.second * in;
    carried = turned.topRows<kNuisances>();
    out.middleRows<kChannels>(order_[k] * kChannels) = turned.bottomRows<kChannels>();
  }
  return out;
}

}  // namespace mgtd::calib
