// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/law_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "calib/discovery/formula_text.h"
#include "calib/effects/effect_context.h"
#include "calib/linear/cholesky.h"
#include "calib/linear/ldlt.h"
#include "calib/linear/normal_draws.h"
#include "calib/linear/propagation.h"
#include "proto/units.h"

namespace mgtd::calib::discovery {
namespace {

constexpr int kPieces = 8, kPoints = 61, kHarmonics = 6;

/// Cubic B-splines on quantiles of what was seen; beyond its ends there is nothing.
class Splines {
 public:
  explicit Splines(Eigen::VectorXd seen) {
    std::sort(seen.begin(), seen.end());
    std::vector<double> inner;
    for (int i = 0; i <= kPieces; ++i) {
      const double at = seen[(seen.size() - 1) * i / kPieces];
      if (inner.empty() || at > inner.back()) inner.push_back(at);
    }
    knots_.assign(3, inner.front());
    knots_.insert(knots_.end(), inner.begin(), inner.end());
    knots_.insert(knots_.end(), 3, inner.back());
  }
  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(knots_.size()) - 4; }
  [[nodiscard]] bool any() const { return count() > 4; }
  [[nodiscard]] double low() const { return knots_.front(); }
  [[nodiscard]] double high() const { return knots_.back(); }

  /// A row for each x (Cox and de Boor).
  [[nodiscard]] Eigen::MatrixXd at(const Eigen::VectorXd& x) const {
    Eigen::MatrixXd out(x.size(), count());
    for (Eigen::Index i = 0; i < x.size(); ++i) out.row(i) = row(x[i]);
    return out;
  }

 private:
  [[nodiscard]] Eigen::RowVectorXd row(double x) const {
    const std::size_t n = knots_.size();
    std::vector<double> b(n - 1, 0.0);
    std::size_t last = 0;
    for (std::size_t i = 0; i + 1 < n; ++i)
      if (knots_[i + 1] > knots_[i] && x >= knots_[i]) last = i;
    b[last] = 1;
    for (std::size_t degree = 1; degree <= 3; ++degree) {
      for (std::size_t i = 0; i + degree + 1 < n; ++i) {
        const double left = knots_[i + degree] - knots_[i], right = knots_[i + degree + 1] - knots_[i + 1];
        b[i] = (left > 0 ? (x - knots_[i]) / left * b[i] : 0) +
               (right > 0 ? (knots_[i + degree + 1] - x) / right * b[i + 1] : 0);
      }
    }
    return Eigen::Map<const Eigen::RowVectorXd>(b.data(), count());
  }

  std::vector<double> knots_;
};

/// Functions of which a curve is made: splines, or harmonics of an angle that goes all the way round.
struct Functions {
  std::optional<Splines> splines{};
  double low{0}, high{360};

  [[nodiscard]] Eigen::MatrixXd at(const Eigen::VectorXd& x) const {
    if (splines) return splines->at(x);
    Eigen::MatrixXd out(x.size(), 2 * kHarmonics);
    for (int n = 1; n <= kHarmonics; ++n) {
      const Eigen::ArrayXd angle = x.array() * to_rad(n);
      out.col(2 * n - 2) = angle.cos();
      out.col(2 * n - 1) = angle.sin();
    }
    return out;
  }
  /// Its form is the curvature of the curve.
  [[nodiscard]] Eigen::MatrixXd curvature() const {
    if (!splines) {
      Eigen::VectorXd out(2 * kHarmonics);
      for (int n = 1; n <= kHarmonics; ++n) out[2 * n - 2] = out[2 * n - 1] = std::pow(n, 4);
      return out.asDiagonal();
    }
    const Eigen::Index n = splines->count();
    Eigen::MatrixXd D = Eigen::MatrixXd::Zero(n - 2, n);
    for (Eigen::Index i = 0; i + 2 < n; ++i) D(i, i) = 1, D(i, i + 1) = -2, D(i, i + 2) = 1;
    return D.transpose() * D;
  }
};

/// Precision of the prior with the largest evidence.
Eigen::MatrixXd best_prior(const Eigen::MatrixXd& A, const Eigen::VectorXd& v,
                           const Eigen::MatrixXd& curvature) {
  const Eigen::Index n = A.cols();
  const double unit = std::max(A.trace() / static_cast<double>(n), 1e-300);
  Eigen::MatrixXd best;
  double most = -std::numeric_limits<double>::infinity();
  for (int c = -10; c <= 6; ++c) {
    for (int r = -10; r <= 0; r += 2) {
      const Eigen::MatrixXd P = unit * (std::pow(10.0, c / 2.0) * curvature +
                                        std::pow(10.0, r / 2.0) * Eigen::MatrixXd::Identity(n, n));
      const auto prior = linear::Cholesky::of_unscaled(P), posterior = linear::Cholesky::of_unscaled(A + P);
      if (!prior || !posterior) continue;
      const double evidence =
          posterior->squared_length(v) + prior->log_determinant() - posterior->log_determinant();
      if (evidence > most) most = evidence, best = P;
    }
  }
  return best;
}

/// The axis where a law is largest.
int channel_of(const FittedLaw& law, int channels) {
  int out = -1;
  double most = 0;
  for (int c = 0; c < channels; ++c) {
    const Eigen::VectorXd& f = law.law[static_cast<std::size_t>(c)];
    if (f.size() == 0) continue;
    const double size = (f.array() - f.mean()).matrix().norm();
    if (out < 0 || size > most) out = c, most = size;
  }
  return out;
}

/// Values at `x` of points that go straight from one to the next.
double between(const std::vector<std::pair<double, double>>& points, double x) {
  const auto next = std::lower_bound(points.begin(), points.end(), std::pair{x, -1e300});
  if (next == points.begin()) return points.front().second;
  if (next == points.end()) return points.back().second;
  const auto& [a, fa] = *(next - 1);
  const auto& [b, fb] = *next;
  return b > a ? fa + (fb - fa) * (x - a) / (b - a) : fa;
}

}  // namespace

Result<std::optional<LawShape>> law_shape(const std::vector<FittedLaw>& formulas,
                                          const std::vector<std::string>& covariates, LawInputs& inputs,
                                          const ChannelSums& sums, std::uint64_t seed) {
  const bool of_gain = covariates.size() == 2 && covariates.front() == "u";
  if (formulas.empty() || (covariates.size() != 1 && !of_gain)) return std::nullopt;
  const std::string& covariate = covariates.back();
  const int c = channel_of(formulas.front(), sums.channels());
  if (c < 0 || covariate == "gravity" || covariate == "pose" || covariate.starts_with("prev_"))
    return std::nullopt;
  const Eigen::VectorXd u = inputs.name(covariate, c);
  if (!u.allFinite()) return std::nullopt;
  Functions functions;
  if (covariate != "azimuth_deg") {
    functions.splines.emplace(u);
    if (!functions.splines->any()) return std::nullopt;
    functions.low = functions.splines->low(), functions.high = functions.splines->high();
  }
  const double field = effects::kReferenceField_nT;
  const Eigen::VectorXd x =
      of_gain ? Eigen::VectorXd(inputs.name("u", c) / field) : Eigen::VectorXd::Ones(u.size());
  const Eigen::MatrixXd at_poses = functions.at(u), B = x.asDiagonal() * at_poses;
  const Eigen::MatrixXd A = B.transpose() * sums.product(c, c, B);
  const Eigen::VectorXd v = B.transpose() * sums.score(c);
  const auto information = linear::Cholesky::of_unscaled(A + best_prior(A, v, functions.curvature()));
  if (!information) return std::nullopt;
  const Eigen::MatrixXd C = information->inverse();
  // Gauge: what the calibration takes up of any curve goes out of this one.
  const bool own = covariate == "u" || covariate == "ux" || covariate == "uy" || covariate == "uz";
  const Eigen::VectorXd weight = sums.before_of_one(c).cwiseProduct(x).cwiseProduct(x).cwiseMax(0);
  const Eigen::VectorXd points = Eigen::VectorXd::LinSpaced(kPoints, functions.low, functions.high);
  Eigen::MatrixXd F(u.size(), own ? 2 : 1), F_at(kPoints, F.cols());
  F.col(0).setOnes(), F_at.col(0).setOnes();
  if (own) F.col(1) = u, F_at.col(1) = points;
  const Eigen::MatrixXd to_gauge =
      F_at * linear::solve_by_ldlt(F.transpose() * weight.asDiagonal() * F,
                                   Eigen::MatrixXd(F.transpose() * weight.asDiagonal()));
  const Eigen::MatrixXd M = functions.at(points) - to_gauge * at_poses;
  const Eigen::VectorXd y = M * (C * v), sd = linear::propagated_variances(M, C).cwiseMax(0).cwiseSqrt();
  LawShape out{.covariate = shown_covariate(covariate, {Place::Kind::axis, c}),
               .where = Place{Place::Kind::axis, c}.name(),
               .of_gain = of_gain};
  out.x.assign(points.begin(), points.end());
  out.y_nT.assign(y.begin(), y.end());
  out.sd_nT.assign(sd.begin(), sd.end());
  constexpr Eigen::Index kDraws = 400;
  const Eigen::MatrixXd draws = M * linear::normal_draws(C, kDraws, seed);
  std::vector<double> largest;
  for (Eigen::Index i = 0; i < kDraws; ++i)
    largest.push_back((draws.col(i).array().abs() / sd.array().max(1e-300)).maxCoeff());
  std::sort(largest.begin(), largest.end());
  out.simultaneous = largest[static_cast<std::size_t>(0.95 * kDraws)];
  for (const FittedLaw& formula : formulas) {
    const Eigen::VectorXd& f = formula.law[static_cast<std::size_t>(c)];
    if (f.size() == 0) continue;
    std::vector<std::pair<double, double>> seen;
    Eigen::VectorXd over_x(u.size());
    for (Eigen::Index k = 0; k < u.size(); ++k) {
      constexpr double kSmall = 0.02;  // of a reading, which says nothing of its gain
      over_x[k] = std::abs(x[k]) > kSmall ? f[k] / x[k] : 0;
      if (std::abs(x[k]) > kSmall) seen.emplace_back(u[k], over_x[k]);
    }
    if (seen.empty()) continue;
    std::sort(seen.begin(), seen.end());
    const Eigen::VectorXd gauge = to_gauge * over_x;
    LawShape::Formula drawn{.formula = shown(formula.columns, formula.place), .y_nT = {}};
    for (Eigen::Index i = 0; i < kPoints; ++i) drawn.y_nT.push_back(between(seen, points[i]) - gauge[i]);
    out.formulas.push_back(std::move(drawn));
  }
  return out;
}

}  // namespace mgtd::calib::discovery
