// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/noise.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "calib/fit/joint/sample_correlation.h"
#include "calib/linear/cholesky.h"
#include "calib/linear/product.h"
#include "calib/stats/chi_square.h"
#include "calib/stats/f_distribution.h"

namespace mgtd::calib::criticism::tests {
namespace {

constexpr double kMaxRho = 0.95;
/// Standard errors that are added to a correlation: too small a one makes every slow effect significant, one
/// too large costs a little power. And the standard error of a median over that of a mean.
constexpr double kCautious = 1.5, kMedianOfMean = 1.25;
/// Angles that are the same pose again, as a table reads them back. What a model misses does not change over
/// so little, and each pose has its own attitude.
const double kSameAngle_rad = to_rad(0.05);
/// The dwells are believed unless the revisits contradict them this clearly.
constexpr double kContradicts_log10_p = -3;

/// Residuals of the readings with the nuisances fitted, and how noise gets into them.
struct Fitted {
  Eigen::MatrixXd e;    ///< channels x P
  Eigen::MatrixXd M;    ///< channels x channels P, pose by pose
  Eigen::MatrixXd J{};  ///< channels P x fixed, the same of the fixed block

  [[nodiscard]] auto M_of(Eigen::Index pose) const { return M.middleCols(pose * M.rows(), M.rows()); }
};

Fitted fitted(const fit::joint::JointProblem& problem, const fit::joint::JointState& state, bool with_fixed) {
  const LinearRows rows = observation_rows(problem, state);
  const RowSource fixed = fixed_source(problem, state);
  const auto n = static_cast<Eigen::Index>(problem.poses.size());
  const Eigen::Index channels = problem.channels(), block_rows = problem.pose_rows();
  Fitted out{.e = Eigen::MatrixXd(channels, n), .M = Eigen::MatrixXd::Zero(channels, channels * n)};
  if (with_fixed) out.J.resize(channels * n, problem.fixed());
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto N = rows.nuisance.middleRows(k * block_rows, block_rows);
    const Eigen::Matrix4d H = sensor::over_rows<sensor::kChannels + 4>(
        block_rows, [&](auto r) -> Eigen::Matrix4d { return N.topRows(r).transpose() * N.topRows(r); });
    const Eigen::LLT<Eigen::Matrix4d> llt(H);
    const auto top = N.topRows(channels);
    const auto weight = problem.poses[static_cast<std::size_t>(k)].weight;
    auto M = out.M.middleCols(k * channels, channels);
    M.diagonal() = (weight.array() > 0).cast<double>();
    M -= top * llt.solve(top.transpose());
    out.e.col(k) = rows.residual.segment(k * block_rows, channels);
    if (!with_fixed) continue;
    const Eigen::MatrixXd block = fixed.of(std::span(&k, 1));
    out.J.middleRows(k * channels, channels) =
        block.topRows(channels) - top * llt.solve(N.transpose() * block);
  }
  return out;
}

/// Rows whose products are the elements of the hat matrix of the fixed block.
Eigen::MatrixXd leverages(Eigen::MatrixXd J) {
  const Eigen::VectorXd length = J.colwise().norm();
  J *= (length.array() > 0).select(length.cwiseInverse(), 0.0).matrix().asDiagonal();
  Eigen::MatrixXd G = linear::gram(J);
  G.diagonal().array() += 1e-9;
  return linear::Cholesky::of_unscaled(G).value().whiten_rows(std::move(J));
}

/// A pose of known attitude.
struct VisitedPose {
  Eigen::Index pose;
  std::optional<int> mount;
  TableAngles angles;
};

bool same_attitude(const VisitedPose& a, const VisitedPose& b) {
  const auto near = [](double x, double y) {
    const double apart = std::abs(x - y);  // of nearly all pairs of poses this says it without a division
    if (apart > kSameAngle_rad && apart < 2 * std::numbers::pi - 2 * kSameAngle_rad) return false;
    return std::abs(std::remainder(x - y, 2 * std::numbers::pi)) < kSameAngle_rad;
  };
  return near(a.angles.azimuth_rad, b.angles.azimuth_rad) && near(a.angles.pitch_rad, b.angles.pitch_rad) &&
         near(a.angles.roll_rad, b.angles.roll_rad) && a.mount == b.mount;
}

/// Each pose with the next visit to its attitude.
std::vector<std::pair<Eigen::Index, Eigen::Index>> revisits(const fit::joint::JointProblem& problem) {
  std::vector<VisitedPose> visits;
  for (std::size_t k = 0; k < problem.poses.size(); ++k) {
    const Pose& pose = *problem.poses[k].pose;
    if (const auto angles = pose.angles())
      visits.push_back({static_cast<Eigen::Index>(k), pose.mount, *angles});
  }
  std::vector<std::pair<Eigen::Index, Eigen::Index>> out;
  for (auto a = visits.begin(); a != visits.end(); ++a) {
    const auto b =
        std::find_if(a + 1, visits.end(), [&](const VisitedPose& v) { return same_attitude(*a, v); });
    if (b != visits.end()) out.emplace_back(a->pose, b->pose);
  }
  return out;
}

/// sum over j of rho^|k-j| x_j: the covariance of the noise times columns over the poses.
Eigen::MatrixXd correlated(const Eigen::MatrixXd& x, double rho) {
  Eigen::MatrixXd out = x, back = x;
  for (Eigen::Index k = 1; k < x.rows(); ++k) out.row(k) += rho * out.row(k - 1);
  for (Eigen::Index k = x.rows() - 2; k >= 0; --k) back.row(k) += rho * back.row(k + 1);
  return out + back - x;
}

/// What one channel shows: its lag-one sum of products and its sum of squares, and those that noise of a
/// given correlation would leave after the fit.
struct LagOne {
  double products{0}, squares{0};
  double by_lag{0}, own{0};  ///< of uncorrelated noise before the fit
  Eigen::MatrixXd L;         ///< hat matrix of the channel is L L'

  [[nodiscard]] std::pair<double, double> expected(double rho) const {
    const Eigen::MatrixXd VL = correlated(L, rho), K = linear::transposed_product(L, VL);
    Eigen::MatrixXd LK(L.rows(), K.cols());
    linear::set_product(L, K, LK);
    const Eigen::Index n = L.rows();
    const auto lag = [n](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
      return a.bottomRows(n - 1).cwiseProduct(b.topRows(n - 1)).sum();
    };
    return {rho * by_lag - lag(L, VL) - lag(VL, L) + lag(LK, L),
            own - 2 * L.cwiseProduct(VL).sum() + LK.cwiseProduct(L).sum()};
  }
};

std::vector<LagOne> lag_one(const fit::joint::JointProblem& problem, const fit::joint::JointState& state) {
  Fitted f = fitted(problem, state, true);
  const Eigen::MatrixXd hat = leverages(std::move(f.J));
  const auto order = order_in_time(problem);
  const Eigen::Index channels = problem.channels();
  std::vector<LagOne> out(static_cast<std::size_t>(channels));
  for (Eigen::Index c = 0; c < channels; ++c) {
    LagOne& x = out[static_cast<std::size_t>(c)];
    x.L.resize(static_cast<Eigen::Index>(order.size()), hat.cols());
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Eigen::Index k = order[i];
      const auto M = f.M_of(k);
      x.L.row(static_cast<Eigen::Index>(i)) = hat.row(k * channels + c);
      x.squares += f.e(c, k) * f.e(c, k);
      x.own += sensor::over_channels(channels, [&](auto n) { return M.row(c).head(n).squaredNorm(); });
      if (i == 0) continue;
      x.products += f.e(c, k) * f.e(c, order[i - 1]);
      const auto before = f.M_of(order[i - 1]);
      x.by_lag += sensor::over_channels(channels,
                                        [&](auto n) { return M.row(c).head(n).dot(before.row(c).head(n)); });
    }
  }
  return out;
}

double median_correlation(const fit::joint::JointProblem& problem, const fit::joint::JointState& state) {
  const std::vector<LagOne> channels = lag_one(problem, state);
  std::vector<double> seen;
  for (const LagOne& c : channels) seen.push_back(c.squares > 0 ? c.products / c.squares : 0);
  std::sort(seen.begin(), seen.end());
  const std::size_t half = seen.size() / 2;
  const double median = seen.size() % 2 == 0 ? (seen[half - 1] + seen[half]) / 2 : seen[half];
  // What would show as the median: the curve rises with rho, and a step of 0.05 is straight enough.
  double rho = 0, last = -1;
  for (double trial = 0; trial < kMaxRho + 1e-9; trial += 0.05) {
    double products = 0, squares = 0;
    for (const LagOne& c : channels) {
      const auto [lag, own] = c.expected(trial);
      products += lag, squares += own;
    }
    const double shown = products / squares;
    if (shown >= median) return trial == 0 ? 0 : rho + 0.05 * (median - last) / (shown - last);
    rho = trial, last = shown;
  }
  return kMaxRho;
}

/// Factors that bring the residuals of two visits, each in units of its own noise, to units in which the same
/// misfit is the same number. Zero where one of them was left out; one where both weigh alike.
std::pair<fit::joint::Channels, fit::joint::Channels> in_common_units(const fit::joint::Channels& u,
                                                                      const fit::joint::Channels& v) {
  const fit::joint::Channels length = (u.cwiseAbs2() + v.cwiseAbs2()).cwiseSqrt();
  const auto both = (u.array() > 0) && (v.array() > 0);
  const double root2 = std::sqrt(2.0);
  return {both.select(root2 * v.array() / length.array(), 0.0).matrix(),
          both.select(root2 * u.array() / length.array(), 0.0).matrix()};
}

}  // namespace

double pose_correlation(const fit::joint::JointProblem& problem, const fit::joint::JointState& state) {
  // One sensor leaves one direction a pose, which changes from pose to pose: channels cannot be taken one by
  // one.
  if (problem.sensors() == 1 && !problem.platform_reference())
    return std::clamp(fit::joint::sample_correlation(problem, state).seen(), 0.0, kMaxRho);
  const double rho = median_correlation(problem, state);
  if (rho <= kCorrelated) return rho;
  const double values = problem.channels() * static_cast<double>(problem.poses.size());
  return std::min(kMaxRho, rho + kCautious * kMedianOfMean * std::sqrt((1 - rho * rho) / values));
}

std::optional<PureError> pure_error(const fit::joint::JointFit& fit, double chi2, double dof) {
  const auto pairs = revisits(fit.problem);
  if (pairs.empty()) return std::nullopt;
  // At the stated noise, whatever noise_inflation the fit used: else the angles of the table, each with
  // its own error, pull at the attitudes.
  fit::joint::JointProblem problem = fit.problem;
  fit::joint::JointState state = fit.state;
  if (fit.noise_inflation > 1) {
    for (fit::joint::JointPose& pose : problem.poses) {
      pose.weight *= fit.noise_inflation;
      pose.f_weight *= fit.noise_inflation;
      pose.reference_weight *= fit.noise_inflation;
    }
    fit::joint::refit_nuisances(problem, state);
  }
  const Fitted f = fitted(problem, state, false);
  PureError out{.pairs = static_cast<int>(pairs.size())};
  double squares = 0, expected = 0;
  for (const auto& pair : pairs) {
    const auto u = pair.first, v = pair.second;
    const auto a = static_cast<std::size_t>(u), b = static_cast<std::size_t>(v);
    const auto units = in_common_units(problem.poses[a].weight, problem.poses[b].weight);
    const auto &by_u = units.first, &by_v = units.second;
    sensor::over_channels(by_u.size(), [&](auto n) {
      squares +=
          (by_u.head(n).cwiseProduct(f.e.col(u).head(n)) - by_v.head(n).cwiseProduct(f.e.col(v).head(n)))
              .squaredNorm();
      expected += (by_u.head(n).asDiagonal() * f.M_of(u).topLeftCorner(n, n)).squaredNorm() +
                  (by_v.head(n).asDiagonal() * f.M_of(v).topLeftCorner(n, n)).squaredNorm();
    });
  }
  if (!(expected > 0)) return std::nullopt;
  out.nu = expected / 2;
  out.ratio = squares / expected;
  const double lack_of_fit =
                   std::max(0.0, chi2 * fit.noise_inflation * fit.noise_inflation - out.ratio * out.nu),
               lack_of_fit_dof = dof - out.nu;
  if (lack_of_fit_dof > 0) {
    out.F = lack_of_fit / lack_of_fit_dof / out.ratio;
    out.log10_p = stats::f_log10_p(out.F, lack_of_fit_dof, out.nu);
    out.model_nT = fit.noise_nT() * std::sqrt(std::max(0.0, lack_of_fit / lack_of_fit_dof - out.ratio));
  }
  return out;
}

NoiseModel noise_model(const fit::joint::JointFit& fit, const Residual& residual) {
  NoiseModel out{.rho = residual.whitener().rho(),
                 .revisits = pure_error(fit, residual.chi2(), residual.dof()),
                 .reference = {.dof = residual.dof()}};
  out.known = fit.sample_noise_nT.has_value();
  out.quantisation_nT = fit.quantisation.step_nT;
  NoiseReference& n = out.reference;
  // What lasts from one pose to the next is not seen within a dwell, and what a model far off leaves is no
  // noise: its size is that of the residual.
  const bool lasting = out.correlated() || fit.noise_inflation > 1 || residual.whitener().wanders();
  n.known = out.known && !lasting;
  n.by_channel = !out.known;
  n.channels = static_cast<int>(residual.channels());
  if (lasting) n.scale2 = residual.chi2() / residual.dof();
  if (n.known && out.revisits) {
    const PureError& p = *out.revisits;
    if (stats::chi_square_log10_p(p.ratio * p.nu, p.nu) < kContradicts_log10_p) {
      n.scale2 = p.ratio;
      n.nu = p.nu;
    }
  }
  n.chi2 = residual.chi2() / n.scale2;
  return out;
}

}  // namespace mgtd::calib::criticism::tests
