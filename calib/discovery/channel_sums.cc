// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/channel_sums.h"

#include <algorithm>
#include <cmath>

#include "calib/criticism/tests/rows.h"
#include "calib/effects/laws/site_gradient.h"
#include "calib/linear/product.h"
#include "calib/linear/symmetric_eigen.h"

namespace mgtd::calib::discovery {
namespace {

namespace tests = criticism::tests;

}  // namespace

Eigen::VectorXd length_left(const Eigen::VectorXd& left2, const Eigen::VectorXd& about_mean2,
                            const Eigen::VectorXd& whole2, double share) {
  const auto least = (share * share * about_mean2.array()).max(kRounding * kRounding * whole2.array());
  return (left2.array() > least && left2.array() > 0).select(left2.array().max(1e-300).rsqrt(), 0.0);
}

Eigen::MatrixXd combinations(const Eigen::MatrixXd& left, const Eigen::MatrixXd& before, double share) {
  constexpr double kSameDirection = 1e-6;  // eigenvalues below are rounding
  const auto orthonormal = [](const Eigen::MatrixXd& products, double least) -> Eigen::MatrixXd {
    const linear::SymmetricEigen eigen = linear::symmetric_eigen(products);
    const Eigen::Index rank = (eigen.values.array() > least).count();
    return eigen.vectors.rightCols(rank) *
           eigen.values.tail(rank).cwiseSqrt().cwiseInverse().asDiagonal().toDenseMatrix();
  };
  // A single column has been held against its length already.
  if (share <= kAbsorbedShare || left.rows() == 1) return orthonormal(left, kSameDirection);
  const Eigen::MatrixXd unit = orthonormal(before, kSameDirection * before.trace());
  if (unit.cols() == 0) return unit;
  return unit * orthonormal(unit.transpose() * left.selfadjointView<Eigen::Lower>() * unit, share * share);
}

Eigen::MatrixXd gradient_rows(const fit::joint::JointProblem& problem, const fit::joint::JointState& state) {
  if (!problem.has_angles || problem.sensors() < 2)
    return {static_cast<Eigen::Index>(problem.poses.size()) * problem.pose_rows(), 0};
  return tests::effect_rows(problem, state, std::make_shared<const effects::laws::SiteGradient>());
}

Eigen::VectorXd law_rows(const LawOnChannels& law, const fit::joint::JointProblem& problem,
                         const Eigen::MatrixXd& of_gradient) {
  const Eigen::Index block = problem.pose_rows();
  Eigen::VectorXd out = Eigen::VectorXd::Zero(block * static_cast<Eigen::Index>(problem.poses.size()));
  for (std::size_t c = 0; c < law.size(); ++c) {
    const auto channel = static_cast<Eigen::Index>(c);
    for (Eigen::Index k = 0; k < law[c].size(); ++k) {
      if (channel < problem.channels()) {
        out[k * block + channel] += problem.poses[static_cast<std::size_t>(k)].weight[channel] * law[c][k];
      } else {
        out.segment(k * block, block) +=
            law[c][k] * of_gradient.col(channel - problem.channels()).segment(k * block, block);
      }
    }
  }
  return out;
}

namespace {

/// The rows of one unit on each channel, at every pose.
Eigen::MatrixXd unit_rows(const fit::joint::JointProblem& problem, const fit::joint::JointState& state) {
  const auto poses = static_cast<Eigen::Index>(problem.poses.size());
  const Eigen::Index block = problem.pose_rows();
  const Eigen::MatrixXd gradient = gradient_rows(problem, state);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(poses * block, problem.channels() + gradient.cols());
  for (Eigen::Index k = 0; k < poses; ++k)
    out.block(k * block, 0, problem.channels(), problem.channels()).diagonal() =
        problem.poses[static_cast<std::size_t>(k)].weight;
  out.rightCols(gradient.cols()) = gradient;
  return out;
}

/// A column of its own for each pose.
Eigen::MatrixXd apart(const Eigen::VectorXd& rows, Eigen::Index poses) {
  const Eigen::Index block = rows.size() / poses;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows.size(), poses);
  for (Eigen::Index k = 0; k < poses; ++k)
    out.col(k).segment(k * block, block) = rows.segment(k * block, block);
  return out;
}

}  // namespace

ChannelSums::ChannelSums(const fit::joint::JointFit& fit, const tests::Residual& residual)
    : poses_(residual.poses()),
      rows_(residual.rows_per_pose()),
      channels_(fit.problem.channels()),
      correlated_(residual.whitener().rho() != 0 || residual.whitener().wanders()),
      absorbed_share_(std::max(kAbsorbedShare, residual.absorbed())),
      basis_(residual.basis()) {
  const Eigen::MatrixXd rows = unit_rows(fit.problem, fit.state);
  total_ = static_cast<int>(rows.cols());
  const Eigen::Index n = poses_ * rows_;
  const auto Q = basis_.topRows(n);
  const auto r = residual.value().head(n);
  const Eigen::MatrixXd together = correlated_ ? Eigen::MatrixXd() : residual.whitener().apply(rows);
  for (int c = 0; c < total_; ++c) {
    Column column;
    Eigen::VectorXd score(poses_);
    Eigen::MatrixXd taken(basis_.cols(), poses_);
    if (correlated_) {
      column.full = residual.whitener().apply(apart(rows.col(c), poses_)) / residual.unit();
      score = column.full.transpose() * r;
      taken.noalias() = Q.transpose() * column.full;
    } else {
      column.block = together.col(c) / residual.unit();
      for (Eigen::Index k = 0; k < poses_; ++k) {
        const auto own = column.block.segment(k * rows_, rows_);
        score[k] = own.dot(r.segment(k * rows_, rows_));
        taken.col(k).noalias() = Q.middleRows(k * rows_, rows_).transpose() * own;
      }
    }
    columns_.push_back(std::move(column));
    scores_.emplace_back(std::move(score));
    taken_.push_back(std::move(taken));
  }
  before_.resize(static_cast<std::size_t>(total_));
  for (std::size_t c = 0; c < columns_.size(); ++c)
    for (std::size_t d = c; d < columns_.size(); ++d)
      before_[c].push_back(column_products(columns_[c], columns_[d]));
}

Eigen::MatrixXd ChannelSums::column_products(const Column& a, const Column& b) const {
  if (correlated_) return a.full.transpose() * b.full;
  Eigen::MatrixXd out(poses_, 1);
  for (Eigen::Index k = 0; k < poses_; ++k)
    out(k, 0) = a.block.segment(k * rows_, rows_).dot(b.block.segment(k * rows_, rows_));
  return out;
}

Eigen::MatrixXd ChannelSums::before_projection(int c, int d, const Eigen::MatrixXd& g) const {
  const auto low = static_cast<std::size_t>(std::min(c, d)), high = static_cast<std::size_t>(std::max(c, d));
  const Eigen::MatrixXd& h = before_[low][high - low];
  if (!correlated_) return h.col(0).asDiagonal() * g;
  if (c > d) return linear::transposed_product(h, g);
  Eigen::MatrixXd out(h.rows(), g.cols());
  linear::set_product(h, g, out);
  return out;
}

Eigen::MatrixXd ChannelSums::taken_up(int c, const Eigen::MatrixXd& g) const {
  const Eigen::MatrixXd& taken = taken_[static_cast<std::size_t>(c)];
  Eigen::MatrixXd out(taken.rows(), g.cols());
  linear::set_product(taken, g, out);
  return out;
}

Eigen::MatrixXd ChannelSums::product(int c, int d, const Eigen::MatrixXd& g) const {
  Eigen::MatrixXd out = before_projection(c, d, g);
  out.noalias() -= taken_[static_cast<std::size_t>(c)].transpose() * taken_up(d, g);
  return out;
}

double ChannelSums::product(const LawOnChannels& a, const LawOnChannels& b) const {
  double out = 0;
  for (std::size_t c = 0; c < a.size(); ++c)
    for (std::size_t d = 0; d < b.size(); ++d)
      if (a[c].size() > 0 && b[d].size() > 0)
        out += a[c].dot(product(static_cast<int>(c), static_cast<int>(d), b[d]).col(0));
  return out;
}

double ChannelSums::by_residual(const LawOnChannels& a) const {
  double out = 0;
  for (std::size_t c = 0; c < a.size(); ++c)
    if (a[c].size() > 0) out += a[c].dot(scores_[c].col(0));
  return out;
}

std::vector<Eigen::VectorXd> ChannelSums::by_channel(const LawOnChannels& a) const {
  std::vector<Eigen::VectorXd> out;
  for (int c = 0; c < total_; ++c) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(poses_);
    for (std::size_t d = 0; d < a.size(); ++d)
      if (a[d].size() > 0) sum += product(c, static_cast<int>(d), a[d]).col(0);
    out.push_back(std::move(sum));
  }
  return out;
}

void ChannelSums::take_out(const LawOnChannels& law) {
  double before = 0;
  for (std::size_t c = 0; c < law.size(); ++c)
    if (law[c].size() > 0)
      before += law[c].dot(before_projection(static_cast<int>(c), static_cast<int>(c), law[c]).col(0));
  const double length2 = product(law, law);
  if (!(length2 > kRounding * kRounding * before)) return;
  TakenOut out{.law = law, .by_channel = {}};
  for (Eigen::VectorXd& on_channel : out.law) on_channel /= std::sqrt(length2);
  out.by_channel = by_channel(out.law);
  const double along = by_residual(out.law);
  for (std::size_t c = 0; c < scores_.size(); ++c) {
    scores_[c] -= along * out.by_channel[c];
    Eigen::MatrixXd& taken = taken_[c];
    taken.conservativeResize(taken.rows() + 1, Eigen::NoChange);
    taken.bottomRows(1) = out.by_channel[c].transpose();
  }
  taken_out_.push_back(std::move(out));
}

Scores ChannelSums::draws(Eigen::Index count, std::mt19937_64& random) const {
  std::normal_distribution<double> normal;
  const Eigen::Index n = poses_ * rows_;
  const Eigen::MatrixXd noise =
      Eigen::MatrixXd::NullaryExpr(basis_.rows(), count, [&] { return normal(random); });
  const Eigen::MatrixXd taken = basis_.transpose() * noise;
  Scores out(static_cast<std::size_t>(total_), Eigen::MatrixXd(poses_, count));
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (correlated_) {
      out[c].noalias() = columns_[c].full.transpose() * noise.topRows(n);
    } else {
      for (Eigen::Index k = 0; k < poses_; ++k)
        out[c].row(k).noalias() =
            columns_[c].block.segment(k * rows_, rows_).transpose() * noise.middleRows(k * rows_, rows_);
    }
    out[c].noalias() -= taken_[c].topRows(basis_.cols()).transpose() * taken;
  }
  for (const TakenOut& law : taken_out_) {
    Eigen::RowVectorXd along = Eigen::RowVectorXd::Zero(count);
    for (std::size_t c = 0; c < law.law.size(); ++c)
      if (law.law[c].size() > 0) along += law.law[c].transpose() * out[c];
    for (std::size_t c = 0; c < out.size(); ++c) out[c].noalias() -= law.by_channel[c] * along;
  }
  return out;
}

ChannelSums::Moments ChannelSums::moments(int channel) const {
  const auto c = static_cast<std::size_t>(channel);
  const Eigen::MatrixXd& h = before_[c].front();
  const Eigen::MatrixXd& U = taken_[c];
  if (correlated_) {
    const Eigen::MatrixXd G = h - U.transpose() * U;
    return {.trace = G.trace(), .squares = G.squaredNorm()};
  }
  // |diag(h) - U'U|^2 without the matrix of poses by poses.
  const Eigen::ArrayXd own = U.colwise().squaredNorm().transpose().array();
  return {
      .trace = h.sum() - own.sum(),
      .squares = h.squaredNorm() - 2 * (h.col(0).array() * own).sum() + (U * U.transpose()).squaredNorm()};
}

}  // namespace mgtd::calib::discovery
