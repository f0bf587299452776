// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/wandering.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

namespace mgtd::calib::fit::joint {
namespace {

using std::numbers::pi;
using std::numbers::sqrt2;
using Terms = Eigen::Matrix<double, kWanderingTerms, 1>;
using Square = Eigen::Matrix<double, kWanderingTerms, kWanderingTerms>;

/// Integrals of sin(t) / t and of (1 - cos(t)) / t from 0 to j pi, j from 1.
struct TrigonometricIntegrals {
  Terms sine, cosine;
};

TrigonometricIntegrals trigonometric_integrals() {
  using Rule = boost::math::quadrature::gauss<double, 15>;
  TrigonometricIntegrals out;
  double sine = 0, cosine = 0;
  for (Eigen::Index i = 0; i < kWanderingTerms; ++i) {
    const double from = static_cast<double>(i) * pi;
    sine += Rule::integrate([](double t) { return std::sin(t) / t; }, from, from + pi);
    cosine += Rule::integrate([](double t) { return (1 - std::cos(t)) / t; }, from, from + pi);
    out.sine[i] = sine, out.cosine[i] = cosine;
  }
  return out;
}

/// What 1/f noise of unit size, seen over a run of unit length, does to the cosines.
struct Flicker {
  Square covariance;  ///< of the coefficients z
  Terms by_end;       ///< their covariance with the offset at the end of the run
};

/// The covariance of two moments is const - ln|u - s|. Its integrals with two cosines, and with one where the
/// other moment is the end of the run, less its mean over the run:
///
///     var z_j          2 (Si(k) / k - (1 - cos k) / k^2)            k = j pi
///     cov(z_j, z_m)    -4 (Cin(k) - Cin(q)) / (k^2 - q^2)           q = m pi, j - m even, else zero
///     cov(z_j, o_end)  sqrt(2) (cos k Si(k) / k + (1 + cos k) Cin(k) / k^2)
Flicker flicker_of_unit_size() {
  const auto [Si, Cin] = trigonometric_integrals();
  Flicker out{.covariance = Square::Zero(), .by_end = {}};
  for (Eigen::Index i = 0; i < kWanderingTerms; ++i) {
    const double k = static_cast<double>(i + 1) * pi, cos_k = i % 2 == 0 ? -1 : 1;
    out.covariance(i, i) = 2 * (Si[i] / k - (1 - cos_k) / (k * k));
    out.by_end[i] = sqrt2 * (cos_k * Si[i] / k + (1 + cos_k) * Cin[i] / (k * k));
    for (Eigen::Index m = i % 2; m < i; m += 2) {
      const double q = static_cast<double>(m + 1) * pi;
      out.covariance(i, m) = out.covariance(m, i) = -4 * (Cin[i] - Cin[m]) / (k * k - q * q);
    }
  }
  return out;
}

const Flicker& flicker() {
  static const Flicker kept = flicker_of_unit_size();
  return kept;
}

}  // namespace

WanderingTerms::WanderingTerms(double from_h, double to_h, SlowSpectrum spectrum, std::size_t poses)
    : from_h_(from_h),
      length_h_(to_h - from_h),
      spectrum_(spectrum),
      poses_(static_cast<double>(std::max<std::size_t>(poses, kWanderingTerms))) {
  if (spectrum == SlowSpectrum::walk) {
    for (Eigen::Index i = 0; i < kWanderingTerms; ++i)
      factor_(i, i) = std::sqrt(std::max(0.0, length_h_)) / (static_cast<double>(i + 1) * pi);
    return;
  }
  Square covariance = flicker().covariance;
  covariance.diagonal().array() -= variance_beyond() / poses_;
  const Eigen::LLT<Square> decomposed(covariance);
  factor_ = decomposed.matrixL();
}

Terms WanderingTerms::at(double t_h) const {
  const double turn = phase(t_h);
  const Terms cosines =
      Terms::NullaryExpr([&](Eigen::Index i) { return sqrt2 * std::cos(static_cast<double>(i + 1) * turn); });
  return factor_.transpose() * cosines;
}

Terms WanderingTerms::by_end() const {
  if (spectrum_ == SlowSpectrum::walk) return at(to_h());
  return factor_.triangularView<Eigen::Lower>().solve(flicker().by_end);
}

double WanderingTerms::variance_at_end() const {
  if (spectrum_ == SlowSpectrum::walk) return length_h_ / 3;
  // Means over a length d of moments whose covariance is const - ln|u - s|: d as a share of the run.
  const double dwell = 0.5 / poses_;
  return 1 - std::log(dwell);
}

double WanderingTerms::variance_beyond() const {
  // Mean over the run: of a walk half of what it is at the end, of 1/f noise 1 less.
  if (spectrum_ == SlowSpectrum::walk) return (variance_at_end() - at(to_h()).squaredNorm()) / 2;
  return variance_at_end() - 1 - flicker().covariance.trace();
}

}  // namespace mgtd::calib::fit::joint
