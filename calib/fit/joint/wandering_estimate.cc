// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/wandering_estimate.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "calib/fit/joint/pose_residuals.h"
#include "calib/linear/cholesky.h"
#include "calib/linear/parts.h"
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

/// What the slow terms add to the normal equations, nuisances eliminated: one column a channel and term.
struct SlowEquations {
  Eigen::MatrixXd by_fixed;  ///< fixed block x slow
  Eigen::MatrixXd gram;      ///< slow x slow
  Eigen::VectorXd by_residual;

  SlowEquations& operator+=(const SlowEquations& other) {
    by_fixed += other.by_fixed, gram += other.gram, by_residual += other.by_residual;
    return *this;
  }
};

/// Rows of the readings by the fixed block, weighted, of one pose.
Eigen::MatrixXd fixed_rows(const JointProblem& problem, const JointPose& pose, const PoseBlocks& b) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(problem.channels(), problem.fixed());
  for (int i = 0; i < problem.sensors(); ++i)
    out.block<3, sensor::kSensorParameters>(3 * i, sensor::kSensorParameters * i) =
        b.linear.d_sensor.middleRows<3>(3 * i);
  out.rightCols(b.linear.d_global.cols()) = b.linear.d_global;
  return pose.weight.asDiagonal() * out;
}

/// What the readings of one pose do once the nuisances have followed, each moved by its standard deviation.
struct FollowedPose {
  sensor::ChannelCovariance readings;  ///< to the readings themselves: a projection
  Eigen::MatrixXd by_fixed;            ///< to the normal equations of the fixed block: fixed x channels
  Channels residual;
};

FollowedPose followed(const JointProblem& problem, const JointPose& pose, const PoseBlocks& b) {
  const Eigen::Index channels = problem.channels();
  const Eigen::LLT<Eigen::Matrix4d> H(b.H);
  const sensor::ChannelColumns<kNuisances> solved = H.solve(b.N.transpose());
  return {.readings = sensor::ChannelCovariance::Identity(channels, channels) - b.N * solved,
          .by_fixed = fixed_rows(problem, pose, b).transpose() - b.U * solved,
          .residual = b.residual - solved.transpose() * b.g};
}

/// The sum over all poses of what `add` adds to `nothing`.
template <class Sum>
Sum sum_over_followed(const JointProblem& problem, const JointState& state, const Sum& nothing,
                      const auto& add) {
  const PoseModel model(problem, state);
  std::vector<Sum> parts(std::max<std::size_t>(1, linear::parts_of_poses(problem.poses.size())), nothing);
  linear::for_each_poses(problem.poses.size(), [&](std::size_t part, std::size_t from, std::size_t to) {
    PoseBlocks b;
    for (std::size_t k = from; k < to; ++k) {
      assemble(problem, model, state, k, Blocks::border, b);
      add(problem.poses[k], followed(problem, problem.poses[k], b), parts[part]);
    }
  });
  for (std::size_t part = 1; part < parts.size(); ++part) parts.front() += parts[part];
  return std::move(parts.front());
}

SlowEquations slow_equations(const JointProblem& problem, const JointState& state,
                             const WanderingTerms& terms) {
  const Eigen::Index channels = problem.channels(), m = channels * kJ;
  const SlowEquations nothing{.by_fixed = Eigen::MatrixXd::Zero(problem.fixed(), m),
                              .gram = Eigen::MatrixXd::Zero(m, m),
                              .by_residual = Eigen::VectorXd::Zero(m)};
  const auto add = [&](const JointPose& pose, const FollowedPose& f, SlowEquations& out) {
    const auto w = pose.weight.asDiagonal();
    const sensor::ChannelCovariance M = w * f.readings * w;
    const Eigen::MatrixXd X = f.by_fixed * w;
    const Channels r = w * f.residual;
    const auto at = terms.at(pose.t_h);
    for (int c = 0; c < channels; ++c) {
      out.by_fixed.middleCols<kJ>(c * kJ) += X.col(c) * at.transpose();
      out.by_residual.segment<kJ>(c * kJ) += r[c] * at;
      for (int d = 0; d <= c; ++d) out.gram.block<kJ, kJ>(c * kJ, d * kJ) += M(c, d) * at * at.transpose();
    }
  };
  SlowEquations out = sum_over_followed(problem, state, nothing, add);
  out.gram.triangularView<Eigen::StrictlyUpper>() = out.gram.transpose();
  return out;
}

/// Of the white noise, over that of the weights: what all readings have, and beside it by channel.
struct WhiteNoise {
  double common;
  Channels beside;
};

/// From pose to pose the terms of a wandering offset beyond the last look white. Where the dwells say how
/// large the white noise is at least, those terms account for what noise_scale2 has above it, as far as the
/// size of the wandering asks for that.
WhiteNoise white_noise(const JointFit& fit, const WanderingEstimate& w, const WanderingTerms& terms) {
  const Eigen::Index channels = fit.problem.channels();
  WhiteNoise out{w.noise_scale2, Channels::Zero(channels)};
  const double least = 1 / (fit.noise_inflation * fit.noise_inflation);
  if (!fit.sample_noise_nT || out.common <= least) return out;
  // One size for all that wander: those of single channels are known to a fifth at best.
  const Channels wanders = (w.size.array() > 0).cast<double>();
  const double beyond_nT2 = w.size.squaredNorm() / wanders.sum() * terms.variance_beyond();
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(channels, 2);  // of what lies beyond, and of freedom
  sums = sum_over_followed(fit.problem, fit.state, sums,
                           [&](const JointPose& pose, const FollowedPose& f, Eigen::MatrixXd& sum) {
                             sum.col(0) += beyond_nT2 * wanders.cwiseProduct(pose.weight.cwiseAbs2());
                             sum.col(1) += f.readings.diagonal();
                           });
  const Channels beyond = sums.col(0) / static_cast<double>(fit.problem.poses.size()), freedom = sums.col(1);
  const double mean = beyond.dot(freedom) / freedom.sum();
  if (!(mean > 0)) return out;
  const double share = std::min(1.0, (out.common - least) / mean);
  out.common -= share * mean;
  out.beside = share * beyond;
  return out;
}

/// What the white noise of single channels adds to the covariance of the fixed block, pose by pose: a product
/// of three matrices would lose what a coarse table knows of the common rotation.
Eigen::MatrixXd covariance_beside(const JointProblem& problem, const JointState& state,
                                  const linear::Cholesky& information, const Channels& beside) {
  const Eigen::MatrixXd nothing = Eigen::MatrixXd::Zero(problem.fixed(), problem.fixed());
  if (!(beside.maxCoeff() > 0)) return nothing;
  const Channels sd = beside.cwiseSqrt();
  return sum_over_followed(
      problem, state, nothing, [&](const JointPose&, const FollowedPose& f, Eigen::MatrixXd& out) {
        const Eigen::MatrixXd errors = information.solve(Eigen::MatrixXd(f.by_fixed * sd.asDiagonal()));
        out.noalias() += errors * errors.transpose();
      });
}

}  // namespace

SlowSums SlowSums::without(const Eigen::MatrixXd& by_columns, const Eigen::VectorXd& r) const {
  return {.gram = gram - by_columns.transpose() * by_columns,
          .by_residual = by_residual - by_columns.transpose() * r,
          .chi2 = chi2 - r.squaredNorm(),
          .dof = dof - static_cast<double>(r.size())};
}

SlowSums SlowSums::thinned(double per_effective) const {
  if (per_effective == 1) return *this;
  return {.gram = gram / per_effective,
          .by_residual = by_residual / per_effective,
          .chi2 = chi2 / per_effective,
          .dof = dof / per_effective};
}

WanderingTerms wandering_terms(const JointProblem& problem, SlowSpectrum spectrum) {
  const auto [first, last] =
      std::minmax_element(problem.poses.begin(), problem.poses.end(),
                          [](const JointPose& a, const JointPose& b) { return a.t_h < b.t_h; });
  return {first->t_h, last->t_h, spectrum, problem.poses.size()};
}

SlowSums slow_sums(const JointFit& fit, SlowSpectrum spectrum) {
  const WanderingTerms terms = wandering_terms(fit.problem, spectrum);
  if (!terms.any()) return {};
  const Reduced all = reduce(fit.problem, fit.state, 0);
  const SlowEquations slow = slow_equations(fit.problem, fit.state, terms);
  const auto information = linear::Cholesky::of(all.S);
  if (!information) return {};
  const Eigen::MatrixXd X = information->whiten(slow.by_fixed);
  const Eigen::VectorXd y = information->whiten(all.g);
  return {.gram = slow.gram - X.transpose() * X,
          .by_residual = slow.by_residual - X.transpose() * y,
          .chi2 = all.cost.total() - y.squaredNorm(),
          .dof = fit.dof + fit.dof_table};
}

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

WanderingEstimate wandering_of(const JointFit& fit) {
  WanderingEstimate best;
  for (const SlowSpectrum spectrum : {SlowSpectrum::walk, SlowSpectrum::flicker}) {
    WanderingEstimate found =
        estimate_wandering(SlowLikelihood(slow_sums(fit, spectrum).thinned(fit.samples_per_effective)));
    found.spectrum = spectrum;
    if (found.evidence > best.evidence) best = std::move(found);
  }
  return best.evidence < kWanderingEvidence + unequal_noise_evidence(fit) ? WanderingEstimate{} : best;
}

std::optional<Eigen::MatrixXd> covariance_with_wandering(const JointFit& fit, const WanderingEstimate& w) {
  const WanderingTerms terms = wandering_terms(fit.problem, w.spectrum);
  const auto information = linear::Cholesky::of(reduce(fit.problem, fit.state, 0).S);
  if (!information || !terms.any()) return std::nullopt;
  const WhiteNoise white = white_noise(fit, w, terms);
  Eigen::MatrixXd errors = information->solve(slow_equations(fit.problem, fit.state, terms).by_fixed);
  Eigen::MatrixXd out = white.common * information->inverse() +
                        covariance_beside(fit.problem, fit.state, *information, white.beside);
  const auto by_end = terms.by_end();
  for (int c = 0; c < fit.problem.channels(); ++c) {
    const int offset = sensor::kSensorParameters * (c / 3) + sensor::ix + c % 3;
    errors.row(offset).segment<kJ>(c * kJ) -= by_end.transpose();
    errors.middleCols<kJ>(c * kJ) *= w.size[c];
    out(offset, offset) += w.size[c] * w.size[c] * (terms.variance_at_end() - by_end.squaredNorm());
  }
  return Eigen::MatrixXd(out + errors * errors.transpose());
}

}  // namespace mgtd::calib::fit::joint
