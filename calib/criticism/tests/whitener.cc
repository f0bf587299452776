// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/whitener.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "calib/linear/parts.h"
#include "calib/linear/product.h"
#include "calib/linear/qr.h"

namespace mgtd::calib::criticism::tests {
namespace {

/// A walk begins at nothing, because the offset of the model is free.
constexpr double kStart_nT = 1e-4;
/// Of a step between two poses at one time.
constexpr double kLeastStep_nT = 1e-6;

/// ln det T'T.
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
    : rho_(rho),
      channels_(problem.channels()),
      pose_rows_(problem.pose_rows()),
      order_(order_in_time(problem)),
      steps_(order_.size()) {
  for (int c = 0; c < nT_per_sqrt_h.size(); ++c)
    if (nT_per_sqrt_h[c] > 0) walking_.push_back(c);
  const Eigen::Index W = walks(), U = unknowns();
  const double fresh = 1 / std::sqrt(1 - rho * rho);
  /// What the rows of a pose, its readings times a factor, feel of the walks and of its nuisances.
  const auto feel = [&](Eigen::Index pose, const Eigen::VectorXd& factor, Eigen::MatrixXd& out) {
    out.setZero(pose_rows_, W + fit::joint::kNuisances);
    for (Eigen::Index i = 0; i < W; ++i) {
      const int c = walking_[static_cast<std::size_t>(i)];
      out(c, i) = factor[c] * problem.poses[static_cast<std::size_t>(pose)].weight[c];
    }
    out.rightCols<fit::joint::kNuisances>() = nuisance.middleRows(pose * pose_rows_, pose_rows_);
    out.topRightCorner(channels_, fit::joint::kNuisances).array().colwise() *= factor.array();
  };
  std::vector<double> log_dets(order_.size(), 0);  // of the nuisances that are a pose's alone
  if (!remembers()) {
    linear::for_each_poses(order_.size(), [&](std::size_t, std::size_t from, std::size_t to) {
      linear::TriangularisingRotation of_nuisances;
      for (std::size_t k = from; k < to; ++k) {
        of_nuisances.turn(nuisance.middleRows(order_[k] * pose_rows_, pose_rows_));
        log_dets[k] = log_det_of(of_nuisances.triangle());
        steps_[k].alone = of_nuisances.rows_from(fit::joint::kNuisances);
      }
    });
  }
  linear::TriangularisingRotation of_last, of_left;
  Eigen::MatrixXd carried = Eigen::MatrixXd::Zero(U, U), own, own_before;
  Eigen::MatrixXd last(U + W + coupled(), U), mine(U + W + coupled(), U), left(W + own_rows(), U);
  Eigen::VectorXd now(channels_), before(channels_);
  for (std::size_t k = 0; k < order_.size(); ++k) {
    Step& step = steps_[k];
    const auto& pose = problem.poses[static_cast<std::size_t>(order_[k])];
    // Readings, scalar reference, and what stands in the place of the attitude, less the pose's own unknowns.
    rank_ +=
        static_cast<int>((pose.weight.array() > 0).count()) + (pose.f_weight > 0 ? 1 : 0) + pose.beside();
    now.setOnes();
    before.setZero();
    const auto* previous = k > 0 ? &problem.poses[static_cast<std::size_t>(order_[k - 1])] : nullptr;
    if (previous != nullptr && remembers()) {
      const auto both = (pose.weight.array() > 0 && previous->weight.array() > 0).cast<double>();
      now = 1 + both * (fresh - 1);
      before = -rho * fresh * both;
    }
    log_det_ += log_dets[k];
    if (remembers()) step.now = now, step.before = before;
    if (U == 0) continue;
    feel(order_[k], now, own);
    if (!remembers()) own = step.alone * own.leftCols(W);
    last.setZero();
    mine.setZero();
    last.topRows(U) = carried;
    if (previous != nullptr) {
      if (remembers()) {
        feel(order_[k - 1], before, own_before);
        last.bottomRows(channels_) = own_before.topRows(channels_);
      }
      const double root_h = std::sqrt(std::max(0.0, pose.t_h - previous->t_h));
      for (Eigen::Index i = 0; i < W; ++i) {
        const double step_nT = nT_per_sqrt_h[walking_[static_cast<std::size_t>(i)]] * root_h;
        mine(U + i, i) = 1 / std::max(step_nT, kLeastStep_nT);
        last(U + i, i) = -mine(U + i, i);
        log_det_ -= 2 * std::log(mine(U + i, i));
      }
    } else {
      for (Eigen::Index i = 0; i < W; ++i) mine(U + i, i) = 1 / kStart_nT;
    }
    mine.bottomRows(coupled()) = own.topRows(coupled());
    of_last.turn(last);
    if (previous != nullptr) log_det_ += log_det_of(of_last.triangle());
    const Eigen::MatrixXd& below = of_last.rows_from(U);
    step.first.resize(W + coupled(), U + coupled());
    step.first << below.leftCols(U), below.rightCols(coupled());
    left.topRows(W + coupled()).noalias() = below * mine;
    left.bottomRows(own_rows() - coupled()) = own.bottomRows(own_rows() - coupled());
    of_left.turn(left);
    step.second = of_left.rows_from(0);
    carried = of_left.triangle();
    if (k + 1 == order_.size()) log_det_ += log_det_of(carried);
  }
}

Eigen::MatrixXd Whitener::apply(const Eigen::MatrixXd& rows) const {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(order_.size()) * rows_per_pose(), rows.cols());
  apply(rows, out);
  return out;
}

void Whitener::apply(const Eigen::MatrixXd& rows, Eigen::Ref<Eigen::MatrixXd> out) const {
  Walk walk(*this, rows.cols());
  in_pieces(out, [&](std::span<const Eigen::Index> poses, Eigen::MatrixXd& piece) {
    for (std::size_t i = 0; i < poses.size(); ++i)
      walk.next(rows.middleRows(poses[i] * pose_rows_, pose_rows_), rows_of(i, piece));
  });
}

void Whitener::apply(const RowSource& rows, Eigen::Ref<Eigen::MatrixXd> out) const {
  Walk walk(*this, rows.columns);
  in_pieces(out, [&](std::span<const Eigen::Index> poses, Eigen::MatrixXd& piece) {
    const Eigen::MatrixXd given = rows.of(poses);
    for (std::size_t i = 0; i < poses.size(); ++i)
      walk.next(given.middleRows(static_cast<Eigen::Index>(i) * pose_rows_, pose_rows_), rows_of(i, piece));
  });
}

/// A column of `out` is long: row by row, each number would be written to a place in memory far from the
/// last.
void Whitener::in_pieces(Eigen::Ref<Eigen::MatrixXd> out, const auto& fill) const {
  constexpr std::size_t kAtATime = 64;
  Eigen::MatrixXd piece(static_cast<Eigen::Index>(kAtATime) * rows_per_pose(), out.cols());
  for (std::size_t from = 0; from < order_.size(); from += kAtATime) {
    const auto poses = std::span(order_).subspan(from, std::min(kAtATime, order_.size() - from));
    fill(poses, piece);
    for (std::size_t i = 0, next = 0; i < poses.size(); i = next) {
      next = i + 1;
      while (next < poses.size() && poses[next] == poses[next - 1] + 1) ++next;
      const Eigen::Index count = static_cast<Eigen::Index>(next - i) * rows_per_pose();
      out.middleRows(poses[i] * rows_per_pose(), count) =
          piece.middleRows(static_cast<Eigen::Index>(i) * rows_per_pose(), count);
    }
  }
}

Eigen::MatrixXd Whitener::apply_transposed(const Eigen::MatrixXd& X) const {
  const Eigen::Index n = X.cols(), U = unknowns(), W = walks(), others = own_rows() - coupled(),
                     left_rows = rows_per_pose();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(order_.size()) * pose_rows_, n);
  Eigen::MatrixXd emitted = Eigen::MatrixXd::Zero(W + own_rows(), n), left(W + own_rows(), n);
  Eigen::MatrixXd in = Eigen::MatrixXd::Zero(U + coupled(), n);
  for (std::size_t k = order_.size(); k-- > 0;) {
    const Step& step = steps_[k];
    const Eigen::Index row = order_[k] * pose_rows_;
    emitted.topRows(U) = in.topRows(U);  // what the pose handed on
    emitted.bottomRows(left_rows) = X.middleRows(order_[k] * left_rows, left_rows);
    if (U > 0) {
      left.noalias() = step.second.transpose() * emitted;
      in.noalias() = step.first.transpose() * left.topRows(W + coupled());
    } else {
      left = emitted;
    }
    if (!remembers()) {
      out.middleRows(row, pose_rows_).noalias() = step.alone.transpose() * left.bottomRows(others);
      continue;
    }
    out.middleRows(row, channels_) += step.now.asDiagonal() * in.bottomRows(channels_);
    out.middleRows(row + channels_, others) = left.bottomRows(others);
    if (k > 0)
      out.middleRows(order_[k - 1] * pose_rows_, channels_) +=
          step.before.asDiagonal() * in.bottomRows(channels_);
  }
  return out;
}

Whitener::Walk::Walk(const Whitener& whitener, Eigen::Index columns) : whitener_(whitener) {
  const Eigen::Index U = whitener.unknowns(), W = whitener.walks(), coupled = whitener.coupled();
  given_.resize(whitener.pose_rows_, columns);
  in_ = linear::RowByRow::Zero(U + coupled, columns);
  turned_.resize(W + coupled, columns);
  own_.resize(whitener.own_rows(), columns);
  left_.resize(W + whitener.own_rows(), columns);
  emitted_.resize(left_.rows(), columns);
}

void Whitener::Walk::next(const Eigen::Ref<const Eigen::MatrixXd>& rows, Eigen::Ref<Eigen::MatrixXd> out) {
  const Step& step = whitener_.steps_[at_];
  const Eigen::Index U = whitener_.unknowns(), coupled = whitener_.coupled();
  given_ = rows;
  if (whitener_.remembers()) {
    in_.bottomRows(coupled) = step.now.asDiagonal() * given_.topRows(coupled);
    if (at_ > 0) in_.bottomRows(coupled) += step.before.asDiagonal() * before_;
    before_ = given_.topRows(coupled);
    own_.bottomRows(own_.rows() - coupled) = given_.bottomRows(own_.rows() - coupled);
  } else {
    linear::set_product(step.alone, given_, own_);
  }
  ++at_;
  if (U == 0) {
    out = own_;
    return;
  }
  linear::set_product(step.first, in_, turned_);
  left_.topRows(turned_.rows()) = turned_;
  left_.bottomRows(left_.rows() - turned_.rows()) = own_.bottomRows(own_.rows() - coupled);
  linear::set_product(step.second, left_, emitted_);
  in_.topRows(U) = emitted_.topRows(U);
  out = emitted_.bottomRows(out.rows());
}

}  // namespace mgtd::calib::criticism::tests
