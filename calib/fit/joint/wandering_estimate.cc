// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/wandering_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/fit/joint/pose_residuals.h"
#include "calib/linear/cholesky.h"
#include "calib/linear/symmetric_eigen.h"

namespace mgtd::calib::fit::joint {
namespace {

constexpr int kJ = kWanderingTerms;
/// What one axis of a place says of its own size is known to a fifth at best. It is weighed with the size of
/// the whole place as if that were so many squares more: axes of one make differ by a quarter, one sd. Else
/// an axis that happens to be calm is stated far too well.
constexpr double kAlikeFreedom = 8;
constexpr int kClimbs = 12;
/// Values of a rate that the likelihood is averaged over: four a decade of its square.
constexpr double kLowest = 0.1, kHighest = 1e7;
constexpr int kPerDecade = 4;

/// Columns of the channels that wander.
std::vector<Eigen::Index> active(const Channels& theta) {
  std::vector<Eigen::Index> out;
  for (Eigen::Index c = 0; c < theta.size(); ++c) {
    for (int j = 0; theta[c] > 0 && j < kJ; ++j) out.push_back(c * kJ + j);
  }
  return out;
}

Eigen::VectorXd roots_of(const Channels& theta, const std::vector<Eigen::Index>& columns) {
  Eigen::VectorXd out(columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i)
    out[static_cast<Eigen::Index>(i)] = std::sqrt(theta[columns[i] / kJ]);
  return out;
}

/// I + D G D; it is positive definite, because G has no negative eigenvalue but for rounding.
linear::Cholesky decomposed(const SlowSums& s, const std::vector<Eigen::Index>& columns,
                            const Eigen::VectorXd& root) {
  Eigen::MatrixXd M = root.asDiagonal() * s.gram(columns, columns) * root.asDiagonal();
  M.diagonal().array() += 1;
  return linear::Cholesky::of_unscaled(M).value();
}

/// Everything about one theta: B = I + D G D with D = sqrt(theta), over the active columns.
struct At {
  std::vector<Eigen::Index> columns;
  Eigen::VectorXd root;
  linear::Cholesky B;
  double Q;             ///< r' V^-1 r
  Eigen::VectorXd sol;  ///< B^-1 D h

  At(const SlowSums& s, const Channels& theta)
      : columns(active(theta)), root(roots_of(theta, columns)), B(decomposed(s, columns, root)) {
    const Eigen::VectorXd h = root.cwiseProduct(s.by_residual(columns));
    sol = B.solve(h);
    Q = s.chi2 - h.dot(sol);
  }
  [[nodiscard]] double log_det() const { return B.log_determinant(); }
};

/// The sums as they are once some channels wander.
SlowSums given(const SlowSums& s, const Channels& theta) {
  const At at(s, theta);
  if (at.columns.empty()) return s;
  const Eigen::MatrixXd GD = s.gram(Eigen::all, at.columns) * at.root.asDiagonal();
  SlowSums out = s;
  out.gram -= GD * at.B.solve(Eigen::MatrixXd(GD.transpose()));
  out.by_residual -= GD * at.sol;
  out.chi2 = at.Q;
  return out;
}

struct Place {
  std::string name;
  std::vector<int> channels;
  double price;  ///< 2 ln of how many are alike
};

std::vector<Place> places(int channels) {
  std::vector<Place> out{{"all", {}, 0}};
  for (int c = 0; c < channels; ++c) out.front().channels.push_back(c);
  for (int i = 0; channels > 3 && 3 * i < channels; ++i)
    out.push_back({fmt::format("s{}", i + 1), {3 * i, 3 * i + 1, 3 * i + 2}, 2 * std::log(channels / 3)});
  for (int c = 0; c < channels; ++c) out.push_back({sensor::channel_name(c), {c}, 2 * std::log(channels)});
  return out;
}

struct Asked {
  double evidence{0}, theta{0};
};

/// One rate for all channels of a place.
Asked ask(const SlowSums& s, const Place& place) {
  std::vector<Eigen::Index> columns;
  for (const int c : place.channels)
    for (int j = 0; j < kJ; ++j) columns.push_back(c * kJ + j);
  const linear::SymmetricEigen eigen = linear::symmetric_eigen(s.gram(columns, columns));
  const Eigen::ArrayXd mu = eigen.values.array().max(0);
  const Eigen::ArrayXd b2 = (eigen.vectors.transpose() * s.by_residual(columns)).array().square();
  if (!(mu.maxCoeff() > 0)) return {};
  std::vector<double> log_likelihood;
  Asked out;
  double best = -std::numeric_limits<double>::infinity();
  const double ratio = std::pow(10.0, 1.0 / kPerDecade);
  for (double x = kLowest; x <= kHighest; x *= ratio) {
    const double theta = x / mu.maxCoeff();
    const double Q = s.chi2 - (theta * b2 / (1 + theta * mu)).sum();
    const double l = -0.5 * ((1 + theta * mu).log().sum() + s.dof * std::log(Q / s.chi2));
    log_likelihood.push_back(l);
    if (l > best) best = l, out.theta = theta;
  }
  double sum = 0;
  for (const double l : log_likelihood) sum += std::exp(l - best);
  out.evidence = 2 * (best + std::log(sum / static_cast<double>(log_likelihood.size()))) - place.price;
  return out;
}

/// The channels that wander, each with the size of its place, and how many squares that size counts as.
struct Grown {
  Channels theta, alike;
};

/// Places one after the other, each given those before, while one is worth saying.
Grown grow(const SlowSums& sums, WanderingEstimate& out) {
  constexpr int kMost = 6;
  const int channels = sums.channels();
  Channels theta = Channels::Zero(channels), alike = theta;
  SlowSums left = sums;
  const std::vector<Place> all = places(channels);
  for (int round = 0; round < kMost; ++round) {
    const Place* best = nullptr;
    Asked found{.evidence = kWanderingEvidence};
    for (const Place& place : all) {
      if (place.name != "all" && theta[place.channels.front()] > 0) continue;
      const Asked asked = ask(left, place);
      if (asked.evidence > found.evidence) found = asked, best = &place;
    }
    if (best == nullptr) break;
    out.evidence += found.evidence;
    if (best->name == "all") out.where.clear();
    out.where.push_back(best->name);
    for (const int c : best->channels) {
      theta[c] += found.theta;
      alike[c] = best->channels.size() > 1 ? kAlikeFreedom : 0;
    }
    if (best->name == "all") break;
    left = given(sums, theta);
  }
  return {theta, alike};
}

}  // namespace

double SlowLikelihood::deviance(const Channels& theta) const {
  const At at(sums_, theta);
  return sums_.dof * std::log(at.Q / sums_.dof) + at.log_det();
}

double SlowLikelihood::quadratic(const Channels& theta) const { return At(sums_, theta).Q; }

double SlowLikelihood::noise_variance(const Channels& theta) const { return quadratic(theta) / sums_.dof; }

void SlowLikelihood::climb(Channels& theta, int steps, const Channels& alike) const {
  const Channels start = theta;
  for (int step = 0; step < steps; ++step) {
    const At at(sums_, theta);
    if (at.columns.empty()) return;
    const double sigma2 = at.Q / sums_.dof;
    // V^-1 seen by the columns: U'V^-1 U = D^-1 (I - B^-1) D^-1, U'V^-1 r = D^-1 B^-1 D h.
    const Eigen::VectorXd inverse = at.B.inverse().diagonal();
    Channels squares = Channels::Zero(theta.size()), trace = squares;
    for (std::size_t i = 0; i < at.columns.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const Eigen::Index c = at.columns[i] / kJ;
      squares[c] += std::pow(at.sol[k] / at.root[k], 2);
      trace[c] += (1 - inverse[k]) / (at.root[k] * at.root[k]);
    }
    for (Eigen::Index c = 0; c < theta.size(); ++c)
      if (theta[c] > 0 && trace[c] > 0)
        theta[c] *= std::sqrt((squares[c] / sigma2 + alike[c] * start[c] / (theta[c] * theta[c])) /
                              (trace[c] + alike[c] / theta[c]));
  }
}

WanderingEstimate estimate_wandering(const SlowLikelihood& likelihood) {
  WanderingEstimate out;
  if (likelihood.sums().gram.size() == 0) return out;
  auto [theta, alike] = grow(likelihood.sums(), out);
  if (!out.any()) return out;
  likelihood.climb(theta, kClimbs, alike);
  const double sigma2 = likelihood.noise_variance(theta);
  out.size = (theta * sigma2).cwiseSqrt();
  out.noise_scale2 = sigma2;
  out.sd = WanderingRates::Zero(theta.size());
  for (Eigen::Index c = 0; c < theta.size(); ++c) {
    if (!(theta[c] > 0)) continue;
    double freedom = alike[c];
    for (int j = 0; j < kJ; ++j) {
      const double x = theta[c] * likelihood.sums().gram(c * kJ + j, c * kJ + j);
      freedom += std::pow(x / (1 + x), 2);
    }
    out.sd[c] = out.size[c] / std::sqrt(2 * std::max(freedom, 0.5));
  }
  return out;
}

double unequal_noise_evidence(const JointFit& fit) {
  const Eigen::ArrayXd squares =
      pose_residuals(fit.problem, fit.state).noise_ratio.reshaped().array().square();
  return std::max(0.0,
                  fit.dof / fit.samples_per_effective * (std::log(squares.mean()) - squares.log().mean()));
}

WanderingEstimate wandering_of(const JointFit& fit, const Reduced& equations, const SlowCosines& cosines) {
  WanderingEstimate best;
  for (const SlowSpectrum spectrum : {SlowSpectrum::walk, SlowSpectrum::flicker}) {
    WanderingEstimate found = estimate_wandering(
        SlowLikelihood(slow_sums(fit, equations, cosines, spectrum).thinned(fit.samples_per_effective)));
    found.spectrum = spectrum;
    if (found.evidence > best.evidence) best = std::move(found);
  }
  return best.evidence < kWanderingEvidence + unequal_noise_evidence(fit) ? WanderingEstimate{} : best;
}

}  // namespace mgtd::calib::fit::joint
