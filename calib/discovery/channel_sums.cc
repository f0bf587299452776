// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/channel_sums.h"

#include <algorithm>
#include <cmath>

#include "calib/criticism/tests/rows.h"
#include "calib/effects/laws/site_gradient.h"
#include "calib/linear/parts.h"
#include "calib/linear/product.h"
#include "calib/linear/symmetric_eigen.h"

namespace mgtd::calib::discovery {
namespace tests = criticism::tests;

double one_over_length_left(double left2, double about_mean2, double whole2, double share) {
  const double least = std::max(share * share * about_mean2, kRounding * kRounding * whole2);
  return left2 > least && left2 > 0 ? 1 / std::sqrt(std::max(left2, 1e-300)) : 0;
}

Eigen::VectorXd one_over_length_left(const Eigen::VectorXd& left2, const Eigen::VectorXd& about_mean2,
                                     const Eigen::VectorXd& whole2, double share) {
  Eigen::VectorXd out(left2.size());
  for (Eigen::Index i = 0; i < out.size(); ++i)
    out[i] = one_over_length_left(left2[i], about_mean2[i], whole2[i], share);
  return out;
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

}  // namespace

const Eigen::VectorXd& ChannelSums::Linearised::before_of(int c, int d) const {
  const auto low = static_cast<std::size_t>(std::min(c, d)), high = static_cast<std::size_t>(std::max(c, d));
  return before[low][high - low];
}

Eigen::MatrixXd ChannelSums::Linearised::spread(int c, const Eigen::MatrixXd& g) const {
  const Eigen::Index block = projection->whitener().pose_rows();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows.rows(), g.cols());
  for (Eigen::Index k = 0; k < g.rows(); ++k) {
    if (c < channels) {
      out.row(k * block + c) = rows(k * block + c, c) * g.row(k);
    } else {
      out.middleRows(k * block, block).noalias() = rows.col(c).segment(k * block, block) * g.row(k);
    }
  }
  return out;
}

Eigen::MatrixXd ChannelSums::Linearised::on_channel(int c, const Eigen::MatrixXd& X) const {
  const Eigen::Index block = projection->whitener().pose_rows(), poses = rows.rows() / block;
  Eigen::MatrixXd out(poses, X.cols());
  for (Eigen::Index k = 0; k < poses; ++k) {
    if (c < channels) {
      out.row(k) = rows(k * block + c, c) * X.row(k * block + c);
    } else {
      out.row(k).noalias() =
          rows.col(c).segment(k * block, block).transpose() * X.middleRows(k * block, block);
    }
  }
  return out;
}

Scores ChannelSums::Linearised::by_channel(const Eigen::MatrixXd& X) const {
  const Eigen::MatrixXd back = projection->whitener().apply_transposed(X) / unit;
  Scores out;
  for (int c = 0; c < rows.cols(); ++c) out.push_back(on_channel(c, back));
  return out;
}

void ChannelSums::Linearised::set_before() {
  const tests::Whitener& whitener = projection->whitener();
  const Eigen::Index poses = rows.rows() / whitener.pose_rows();
  const Eigen::MatrixXd white = whitener.apply(rows) / unit;
  before.resize(static_cast<std::size_t>(rows.cols()));
  for (Eigen::Index c = 0; c < rows.cols(); ++c) {
    for (Eigen::Index d = c; d < rows.cols(); ++d) {
      const Eigen::VectorXd products = white.col(c).cwiseProduct(white.col(d));
      before[static_cast<std::size_t>(c)].emplace_back(
          products.reshaped(whitener.rows_per_pose(), poses).colwise().sum().transpose());
    }
  }
}

void ChannelSums::Linearised::set_each_pose() {
  const tests::Whitener& whitener = projection->whitener();
  const Eigen::Index poses = rows.rows() / whitener.pose_rows();
  each_pose.resize(static_cast<std::size_t>(channels));
  linear::for_each_part(each_pose.size(), [&](std::size_t c) {
    const Eigen::MatrixXd of_pose = Eigen::MatrixXd::Identity(poses, poses);
    each_pose[c] = linear::gram(whitener.apply(spread(static_cast<int>(c), of_pose)) / unit);
  });
}

ChannelSums::ChannelSums(const fit::joint::JointFit& fit, const tests::Residual& residual)
    : poses_(residual.poses()),
      channels_(fit.problem.channels()),
      correlated_(residual.whitener().rho() != 0 || residual.whitener().wanders()),
      absorbed_share_(std::max(kAbsorbedShare, residual.absorbed())) {
  Linearised model{.projection = residual.projection(),
                   .unit = residual.unit(),
                   .rows = unit_rows(fit.problem, fit.state),
                   .channels = channels_,
                   .before = {},
                   .each_pose = {}};
  total_ = static_cast<int>(model.rows.cols());
  if (!correlated_) {
    model.set_before();
  } else if (fit.problem.sensors() == 1) {
    model.set_each_pose();
  }
  const Eigen::Index n = poses_ * residual.rows_per_pose(), p = residual.basis().cols();
  Eigen::MatrixXd both(n, p + 1);
  both << residual.basis().topRows(n), residual.value().head(n);
  for (const Eigen::MatrixXd& on_channel : model.by_channel(both)) {
    taken_.emplace_back(on_channel.leftCols(p).transpose());
    scores_.emplace_back(on_channel.col(p));
  }
  fit_ = std::make_shared<const Linearised>(std::move(model));
  for (int c = 0; c < total_; ++c)
    before_of_one_.emplace_back(before_projection(c, c, Eigen::VectorXd::Ones(poses_)));
}

Eigen::MatrixXd ChannelSums::whitened(int c, const Eigen::MatrixXd& g) const {
  return fit_->projection->whitener().apply(fit_->spread(c, g)) / fit_->unit;
}

Eigen::MatrixXd ChannelSums::before_projection(int c, int d, const Eigen::MatrixXd& g) const {
  if (!correlated_) return fit_->before_of(c, d).asDiagonal() * g;
  const tests::Whitener& whitener = fit_->projection->whitener();
  return fit_->on_channel(c, whitener.apply_transposed(whitened(d, g))) / fit_->unit;
}

Eigen::MatrixXd ChannelSums::before_projection(const std::vector<int>& channels,
                                               const std::vector<Eigen::MatrixXd>& g) const {
  std::vector<Eigen::Index> first{0};
  for (const Eigen::MatrixXd& of_channel : g) first.push_back(first.back() + of_channel.cols());
  if (correlated_) {
    const tests::Whitener& whitener = fit_->projection->whitener();
    Eigen::MatrixXd white(poses_ * whitener.rows_per_pose(), first.back());
    for (std::size_t a = 0; a < g.size(); ++a)
      white.middleCols(first[a], g[a].cols()) = whitened(channels[a], g[a]);
    return linear::gram(white);
  }
  Eigen::MatrixXd out(first.back(), first.back());
  for (std::size_t a = 0; a < g.size(); ++a)
    for (std::size_t b = 0; b <= a; ++b)
      out.block(first[b], first[a], g[b].cols(), g[a].cols()) =
          g[b].transpose() * fit_->before_of(channels[a], channels[b]).asDiagonal() * g[a];
  out.triangularView<Eigen::StrictlyLower>() = out.transpose();
  return out;
}

Eigen::MatrixXd ChannelSums::taken_up(int c, const Eigen::MatrixXd& g) const {
  const Eigen::MatrixXd& taken = taken_[static_cast<std::size_t>(c)];
  Eigen::MatrixXd out(taken.rows(), g.cols());
  linear::set_product(taken, g, out);
  return out;
}

Eigen::MatrixXd ChannelSums::taken_up_by_model(int c, const Eigen::MatrixXd& g) const {
  const Eigen::MatrixXd& taken = taken_[static_cast<std::size_t>(c)];
  Eigen::MatrixXd out(fit_->projection->basis().cols(), g.cols());
  linear::set_product(taken.topRows(out.rows()), g, out);
  return out;
}

Eigen::MatrixXd ChannelSums::taken_up_by_laws(int c, const Eigen::MatrixXd& g) const {
  return taken_[static_cast<std::size_t>(c)].bottomRows(static_cast<Eigen::Index>(taken_out_.size())) * g;
}

Eigen::MatrixXd ChannelSums::products(int c, int d) const {
  const Eigen::MatrixXd &of_c = taken_[static_cast<std::size_t>(c)],
                        &of_d = taken_[static_cast<std::size_t>(d)];
  if (correlated_) {
    const auto& held = fit_->each_pose;
    return (c == d && !held.empty() ? held[static_cast<std::size_t>(c)]
                                    : before_projection(c, d, Eigen::MatrixXd::Identity(poses_, poses_))) -
           linear::transposed_product(of_c, of_d);
  }
  Eigen::MatrixXd out = linear::transposed_product(-of_c, of_d);
  out.diagonal() += fit_->before_of(c, d);
  return out;
}

Eigen::MatrixXd ChannelSums::product(int c, int d, const Eigen::MatrixXd& g) const {
  Eigen::MatrixXd out = before_projection(c, d, g);
  out -= linear::transposed_product(taken_[static_cast<std::size_t>(c)], taken_up(d, g));
  return out;
}

double ChannelSums::product(const LawOnChannels& a, const LawOnChannels& b) const {
  const std::vector<Eigen::VectorXd> of_b = by_channel(b);
  double out = 0;
  for (std::size_t c = 0; c < a.size(); ++c)
    if (a[c].size() > 0) out += a[c].dot(of_b[c]);
  return out;
}

double ChannelSums::by_residual(const LawOnChannels& a) const {
  double out = 0;
  for (std::size_t c = 0; c < a.size(); ++c)
    if (a[c].size() > 0) out += a[c].dot(scores_[c].col(0));
  return out;
}

std::vector<Eigen::VectorXd> ChannelSums::by_channel(const LawOnChannels& a) const {
  Eigen::VectorXd taken = Eigen::VectorXd::Zero(taken_.front().rows());
  std::vector<Eigen::VectorXd> out(taken_.size(), Eigen::VectorXd::Zero(poses_));
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(fit_->rows.rows(), 1);
  for (std::size_t d = 0; d < a.size(); ++d) {
    if (a[d].size() == 0) continue;
    const int channel = static_cast<int>(d);
    taken += taken_[d] * a[d];
    if (correlated_) rows += fit_->spread(channel, a[d]);
    for (std::size_t c = 0; !correlated_ && c < out.size(); ++c)
      out[c] += fit_->before_of(static_cast<int>(c), channel).cwiseProduct(a[d]);
  }
  if (correlated_) {
    const Scores before = fit_->by_channel(fit_->projection->whitener().apply(rows) / fit_->unit);
    for (std::size_t c = 0; c < out.size(); ++c) out[c] = before[c];
  }
  for (std::size_t c = 0; c < out.size(); ++c) out[c] -= taken_[c].transpose() * taken;
  return out;
}

void ChannelSums::take_out(const LawOnChannels& law) {
  double before = 0;
  for (std::size_t c = 0; c < law.size(); ++c)
    if (law[c].size() > 0)
      before += before_projection({static_cast<int>(c)}, {Eigen::MatrixXd(law[c])})(0, 0);
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

Eigen::MatrixXd ChannelSums::noise(Eigen::Index count, std::mt19937_64& random) const {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(fit_->projection->basis().rows(), count,
                                      [&] { return normal(random); });
}

Scores ChannelSums::scores_of(Eigen::MatrixXd noise) const {
  const Eigen::MatrixXd& basis = fit_->projection->basis();
  linear::subtract_product(basis, linear::transposed_product(basis, noise), noise);
  Scores out = fit_->by_channel(noise.topRows(poses_ * fit_->projection->whitener().rows_per_pose()));
  for (const TakenOut& law : taken_out_) {
    Eigen::RowVectorXd along = Eigen::RowVectorXd::Zero(noise.cols());
    for (std::size_t c = 0; c < law.law.size(); ++c)
      if (law.law[c].size() > 0) along += law.law[c].transpose() * out[c];
    for (std::size_t c = 0; c < out.size(); ++c) out[c].noalias() -= law.by_channel[c] * along;
  }
  return out;
}

ChannelSums::Moments ChannelSums::moments(int channel) const {
  if (correlated_) {
    const Eigen::MatrixXd G = products(channel, channel);
    return {.trace = G.trace(), .squares = G.squaredNorm()};
  }
  const Eigen::VectorXd& h = fit_->before_of(channel, channel);
  const Eigen::MatrixXd& U = taken_[static_cast<std::size_t>(channel)];
  // |diag(h) - U'U|^2 without the matrix of poses by poses.
  const Eigen::ArrayXd own = U.colwise().squaredNorm().transpose().array();
  return {.trace = h.sum() - own.sum(),
          .squares = h.squaredNorm() - 2 * (h.array() * own).sum() + (U * U.transpose()).squaredNorm()};
}

}  // namespace mgtd::calib::discovery
