// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/live/live_follow.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "calib/linear/cholesky.h"
#include "calib/linear/inverse.h"
#include "calib/linear/propagation.h"
#include "calib/linear/qr.h"
#include "calib/linear/symmetric_eigen.h"
#include "calib/stats/chi_square.h"
#include "calib/stats/median.h"

namespace mgtd::calib::criticism::live {
namespace {

constexpr std::size_t kLeastBlocks = 18;
constexpr double kLeastSpread = 0.02;     // of b/F0, rms: one degree
constexpr double kLeastRange_degC = 0.3;  // below it the thermometer's own steps count
constexpr double kLeastSpan = 60;         // blocks, to distinguish a drift from noise
constexpr double kMostCorrelation = 0.95;

/// Blocks as rows: closure whitened by the noise of one sample, times the root of the number of samples.
struct Rows {
  Eigen::MatrixXd c;  ///< n x d
  Eigen::VectorXd root_n;
  Eigen::MatrixXd u;     ///< n x 3
  Eigen::VectorXd t, T;  ///< T: NaN where unknown
  Eigen::MatrixXd unwhiten;

  [[nodiscard]] Eigen::Index n() const { return c.rows(); }
  /// Columns times the weights, so that every row has the same noise.
  [[nodiscard]] Eigen::MatrixXd weighted(const Eigen::MatrixXd& columns) const {
    return root_n.asDiagonal() * columns;
  }
};

Rows rows_of(const std::deque<ClosureBlock>& blocks, const ClosurePrior& prior) {
  const auto n = static_cast<Eigen::Index>(blocks.size());
  Rows out{Eigen::MatrixXd(n, prior.numbers()),
           Eigen::VectorXd(n),
           Eigen::MatrixXd(n, 3),
           Eigen::VectorXd(n),
           Eigen::VectorXd(n),
           prior.sample_noise.llt().matrixL()};
  const auto L = prior.sample_noise.llt();
  for (Eigen::Index k = 0; k < n; ++k) {
    const ClosureBlock& b = blocks[static_cast<std::size_t>(k)];
    out.root_n[k] = std::sqrt(b.samples);
    out.c.row(k) = out.root_n[k] * L.matrixL().solve(b.closure).transpose();
    out.u.row(k) = b.u.transpose();
    out.t[k] = b.t_s;
    out.T[k] = b.T_degC;
  }
  return out;
}

Eigen::VectorXd centred(const Eigen::VectorXd& x) { return x.array() - x.mean(); }

/// Directions in which the field moved, as columns of u centred and turned; none when it stood.
Eigen::MatrixXd moved_directions(const Rows& r) {
  const Eigen::MatrixXd u = r.u.rowwise() - r.u.colwise().mean();
  const linear::PrincipalAxes axes = linear::principal_axes(u.transpose() * u / static_cast<double>(r.n()));
  std::vector<Eigen::Index> kept;
  for (Eigen::Index a = 0; a < 3; ++a) {
    if (axes.values[a] > kLeastSpread * kLeastSpread) kept.push_back(a);
  }
  return axes.vectors(Eigen::all, kept);
}

Eigen::MatrixXd beside(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd out(a.rows(), a.cols() + b.cols());
  out << a, b;
  return out;
}

/// y less its regression on the columns.
Eigen::MatrixXd residual(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& y) {
  return y - columns * linear::least_squares(columns, y);
}

struct Noise {
  double median{1};    ///< variance of a block against white noise
  double widening{1};  ///< of the variance of slopes, beside: mean square and correlation
};

Noise noise_of(const Rows& r, const std::deque<ClosureBlock>& blocks, const Eigen::MatrixXd& everything) {
  std::vector<double> within, between;
  for (const ClosureBlock& b : blocks) within.push_back(b.excess);
  Noise out{std::max(1.0, stats::median(within)), 1};
  if (r.n() < everything.cols() + 6) return out;
  const Eigen::MatrixXd e = residual(r.weighted(everything), r.c);
  const double spent = static_cast<double>(r.n()) / static_cast<double>(r.n() - everything.cols());
  for (Eigen::Index k = 0; k < r.n(); ++k) between.push_back(spent * e.row(k).squaredNorm());
  const auto d = static_cast<double>(r.c.cols());
  out.median = std::max(out.median, stats::median(between) / stats::chi_square_limit(0.5, d));
  const double mean = spent * e.squaredNorm() / (d * static_cast<double>(r.n()));
  const double lagged = e.topRows(r.n() - 1).cwiseProduct(e.bottomRows(r.n() - 1)).sum() / e.squaredNorm();
  const double correlation = std::clamp(lagged, 0.0, kMostCorrelation);
  out.widening = std::max(1.0, mean / out.median) * (1 + correlation) / (1 - correlation);
  return out;
}

/// Share of what y does beyond its noise (`variance` a row and quantity) that the columns explain.
double share_of(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& y, double variance) {
  const auto n = static_cast<double>(y.rows()), m = static_cast<double>(columns.cols()),
             d = static_cast<double>(y.cols());
  const double left = residual(columns, y).squaredNorm(), all = y.squaredNorm();
  const double excess = all - d * variance * (n - 1);
  return excess <= 0 ? 0 : std::clamp((all - left - d * variance * m) / excess, 0.0, 1.0);
}

/// The same of the best indicator of an interval, y having no mean.
double event_share_of(const Eigen::MatrixXd& y, double variance) {
  const Eigen::Index n = y.rows();
  const auto d = static_cast<double>(y.cols());
  const double excess = y.squaredNorm() - d * variance * static_cast<double>(n - 1);
  if (excess <= 0) return 0;
  Eigen::MatrixXd sums(n + 1, y.cols());
  sums.row(0).setZero();
  for (Eigen::Index k = 0; k < n; ++k) sums.row(k + 1) = sums.row(k) + y.row(k);
  // All intervals of one length at a time.
  double best = 0;
  Eigen::ArrayXd squares(n);
  for (Eigen::Index inside = 1; inside < n; ++inside) {
    const Eigen::Index begins = n + 1 - inside;
    auto square = squares.head(begins);
    square.setZero();
    for (Eigen::Index c = 0; c < y.cols(); ++c)
      square += (sums.col(c).tail(begins) - sums.col(c).head(begins)).array().square();
    const double weight = 1 / static_cast<double>(inside) + 1 / static_cast<double>(n - inside);
    best = std::max(best, weight * square.maxCoeff());
  }
  return std::clamp((best - d * variance) / excess, 0.0, 1.0);
}

/// Prior of W, whitened.
ClosureErrors whitened(const ClosurePrior& prior) {
  const Eigen::Index d = prior.numbers();
  const Eigen::MatrixXd inverse = Eigen::MatrixXd(prior.sample_noise.llt().matrixL()).inverse();
  ClosureErrors out(4 * d, 4 * d);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j)
      out.block(d * i, d * j, d, d) =
          inverse * prior.parameters.block(d * i, d * j, d, d) * inverse.transpose();
  }
  return out;
}

/// Closure that the calibration's own uncertainty may make at this field.
Eigen::MatrixXd stated(const ClosureErrors& parameters, const Eigen::Vector3d& u) {
  const Eigen::Index d = parameters.rows() / 4;
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(d, d);
  Eigen::MatrixXd q(4 * d, d);
  q << one, u[0] * one, u[1] * one, u[2] * one;
  return q.transpose() * parameters * q;
}

/// c against one x, W within its prior.
Following against(const Rows& r, const ClosurePrior& prior, const Eigen::VectorXd& x, const Noise& noise) {
  Following out{.tested = true};
  const double variance = noise.median * noise.widening;
  ClosureErrors P = whitened(prior);
  P.diagonal().array() += 1e-12 * P.trace() + 1e-12;
  Eigen::MatrixXd z(r.n(), 5);
  z << Eigen::VectorXd::Ones(r.n()), r.u, centred(x);
  const Eigen::MatrixXd zw = r.weighted(z), S = zw.transpose() * zw / variance;
  const Eigen::Index d = r.c.cols();
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(5 * d, 5 * d);
  for (Eigen::Index i = 0; i < 5; ++i) {
    for (Eigen::Index j = 0; j < 5; ++j) M.block(d * i, d * j, d, d).diagonal().setConstant(S(i, j));
  }
  M.topLeftCorner(4 * d, 4 * d) += linear::inverse_by_lu(P);
  const Eigen::MatrixXd g = r.c.transpose() * zw / variance;  // d x 5
  const Eigen::MatrixXd V = linear::inverse_by_lu(M);
  const Eigen::VectorXd solution = V * Eigen::VectorXd(g.reshaped());
  const Eigen::VectorXd beta = solution.tail(d);
  const Eigen::MatrixXd cov = V.bottomRightCorner(d, d);
  out.log10_p = stats::chi_square_log10_p(beta.dot(cov.llt().solve(beta)), static_cast<double>(d));
  const Eigen::VectorXd slope = r.unwhiten * beta;
  const Eigen::MatrixXd slope_cov = linear::propagated_covariance(r.unwhiten, cov);
  const Eigen::VectorXd stated_sd =
      stated(prior.parameters, r.u.colwise().mean().transpose()).diagonal().cwiseSqrt();
  out.range = x.maxCoeff() - x.minCoeff();
  (slope.cwiseAbs().array() / stated_sd.array()).maxCoeff(&out.component);
  out.slope = slope[out.component];
  out.slope_sd = std::sqrt(slope_cov(out.component, out.component));
  out.swing = std::abs(out.slope) * out.range;
  out.stated_sd = stated_sd[out.component];
  // What turning the array may do is no part of what x has to explain.
  const Eigen::MatrixXd directions = moved_directions(r);
  Eigen::MatrixXd base = Eigen::VectorXd::Ones(r.n());
  if (directions.cols() > 0) base = beside(base, r.u * directions);
  base = r.weighted(base);
  const Eigen::MatrixXd y = residual(base, r.c);
  out.share = share_of(residual(base, r.weighted(centred(x))), y, noise.median);
  out.event_share = event_share_of(y, noise.median);
  return out;
}

/// c against the directions that the field took.
Following against_attitude(const Rows& r, const ClosurePrior& prior, const Eigen::MatrixXd& V,
                           const Noise& noise) {
  Following out{.tested = true};
  const Eigen::MatrixXd constant = r.weighted(Eigen::VectorXd::Ones(r.n()));
  const Eigen::MatrixXd x = residual(constant, r.weighted(r.u * V)), y = residual(constant, r.c);
  const Eigen::MatrixXd inverse = linear::inverse_by_lu(x.transpose() * x);
  const Eigen::MatrixXd B = (inverse * x.transpose() * y).transpose();  // d x directions
  const Eigen::Index m = B.size(), d = r.c.cols();
  const ClosureErrors P = whitened(prior);
  Eigen::MatrixXd cov = Eigen::MatrixXd::Zero(m, m);
  for (Eigen::Index i = 0; i < V.cols(); ++i) {
    for (Eigen::Index j = 0; j < V.cols(); ++j) {
      auto block = cov.block(d * i, d * j, d, d);
      block.diagonal().setConstant(noise.median * noise.widening * inverse(i, j));
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) block += V(a, i) * V(b, j) * P.block(d * (1 + a), d * (1 + b), d, d);
      }
    }
  }
  const auto by_noise = linear::Cholesky::of_unscaled(cov);
  if (!by_noise) return {};
  out.log10_p = stats::chi_square_log10_p(by_noise->squared_length(B.reshaped()), static_cast<double>(m));
  out.share = share_of(x, y, noise.median);
  out.event_share = event_share_of(y, noise.median);
  // Reported for the quantity that swings most, over the turn that was made.
  const Eigen::MatrixXd made =
      (r.u.rowwise() - r.u.colwise().mean()) * V * (r.unwhiten * B).transpose();  // n x d
  const Eigen::VectorXd swing = (made.colwise().maxCoeff() - made.colwise().minCoeff()).transpose();
  const Eigen::VectorXd stated_sd =
      stated(prior.parameters, r.u.colwise().mean().transpose()).diagonal().cwiseSqrt();
  (swing.array() / stated_sd.array()).maxCoeff(&out.component);
  out.swing = swing[out.component];
  out.stated_sd = stated_sd[out.component];
  const Eigen::MatrixXd spread = (r.u * V).rowwise() - (r.u * V).colwise().mean();
  out.range = spread.rowwise().norm().maxCoeff();
  return out;
}

}  // namespace

WindowCriticism criticise(const std::deque<ClosureBlock>& blocks, const ClosurePrior& prior) {
  WindowCriticism out;
  if (blocks.empty()) return out;
  const Rows r = rows_of(blocks, prior);
  const Eigen::MatrixXd V = moved_directions(r);
  const bool knows_T = r.T.allFinite() && r.T.maxCoeff() - r.T.minCoeff() > kLeastRange_degC;
  const double least_step_s = r.n() > 1 ? (r.t[r.n() - 1] - r.t[0]) / static_cast<double>(r.n() - 1) : 0;
  const bool knows_t = static_cast<double>(r.n()) >= kLeastSpan && least_step_s > 0;
  Eigen::MatrixXd everything = Eigen::VectorXd::Ones(r.n());
  if (V.cols() > 0) everything = beside(everything, r.u * V);
  if (knows_T) everything = beside(everything, centred(r.T));
  if (knows_t) everything = beside(everything, centred(r.t) / 3600);
  const Noise noise = noise_of(r, blocks, everything);
  out.noise_scale = noise.median;
  if (blocks.size() < kLeastBlocks) return out;
  if (knows_T) out.follows[0] = against(r, prior, r.T, noise);
  if (knows_t) out.follows[1] = against(r, prior, r.t / 3600, noise);
  if (V.cols() > 0) out.follows[2] = against_attitude(r, prior, V, noise);
  return out;
}

double block_log10_p(const ClosureBlock& block, const ClosurePrior& prior, double noise_scale) {
  const Eigen::MatrixXd S =
      noise_scale / block.samples * prior.sample_noise + stated(prior.parameters, block.u);
  return stats::chi_square_log10_p(block.closure.dot(S.llt().solve(block.closure)),
                                   static_cast<double>(prior.numbers()));
}

}  // namespace mgtd::calib::criticism::live
