// SPDX-License-Identifier: Apache-2.0
#include "calib/validity/calibration_validity.h"

#include <fmt/format.h>

#include <cmath>

#include "calib/calibration/array_model.h"
#include "calib/fit/fit_report.h"
#include "calib/linear/symmetric_eigen.h"
#include "proto/units.h"

namespace mgtd::calib::validity {
namespace {

constexpr double kLeastScale = 0.1, kMostScale = 10, kMostSkew_rad = to_rad(60);
constexpr double kLeastEigenvalue = -1e-6;  // of a correlation: what rounding leaves of zero, and more

tl::unexpected<Error> invalid(std::string what) {
  return fail(ErrorCode::bad_input, "the calibration cannot be used: " + std::move(what),
              "give a CAL.json written by mgt fit -o");
}

Result<void> validate(const sensor::SensorModel& sensor, int number) {
  for (const double c : sensor.scale) {
    if (c >= kLeastScale && c <= kMostScale) continue;
    return invalid(
        fmt::format("s{} has a scale of {:g}; {:g} to {:g} is possible", number, c, kLeastScale, kMostScale));
  }
  for (const double skew_rad : {sensor.theta_rad, sensor.phi_rad, sensor.psi_rad}) {
    if (std::abs(skew_rad) < kMostSkew_rad) continue;
    return invalid(fmt::format("s{} has a non-orthogonality of {:g} deg; below {:g} is possible", number,
                               to_deg(skew_rad), to_deg(kMostSkew_rad)));
  }
  const Eigen::Array33d M = sensor.mounting.array();
  const bool units = (M == 0 || M.abs() == 1).all();
  if (!units || (M.abs().rowwise().sum() != 1).any() || (M.abs().colwise().sum() != 1).any())
    return invalid(fmt::format("the mounting of s{} is no signed permutation", number));
  return {};
}

/// Effects that do not fit their coefficients have no covariance to look at: call after those are checked.
Result<void> validate_covariance(const calibration::Calibration& c) {
  const Eigen::MatrixXd full = calibration::full_covariance(c);
  const Eigen::VectorXd variance = full.diagonal();
  if ((variance.array() < 0).any()) return invalid("a variance is below zero");
  for (Eigen::Index i = 0; i < full.rows(); ++i) {
    if (variance[i] == 0 && (full.row(i).array() != 0).any())
      return invalid("its covariance is none: what has no variance varies with something");
  }
  const Eigen::VectorXd scale = variance.unaryExpr([](double v) { return v > 0 ? 1 / std::sqrt(v) : 0.0; });
  const Eigen::MatrixXd correlation = scale.asDiagonal() * full * scale.asDiagonal();
  const double least = linear::symmetric_eigenvalues(correlation)[0];
  if (least >= kLeastEigenvalue) return {};
  return invalid(fmt::format("its covariance is none: an eigenvalue of {:.3g}, down to {:g} is rounding",
                             least, kLeastEigenvalue));
}

Result<void> validate_effects(const calibration::Calibration& c) {
  if (auto model = calibration::ArrayModel::of(c); !model) return tl::unexpected(model.error());
  Eigen::Index coefficients = 0;
  for (const calibration::CalibratedEffect& e : c.effects) {
    coefficients += static_cast<Eigen::Index>(e.coefficients.size());
    for (const calibration::EffectCoefficient& coefficient : e.coefficients) {
      if (coefficient.sd < 0) return invalid(fmt::format("{} has a standard deviation below zero", e.effect));
    }
  }
  if (c.effect_covariance.rows() != coefficients) {
    return invalid(fmt::format("{} coefficients of effects, and a covariance of {}", coefficients,
                               c.effect_covariance.rows()));
  }
  return {};
}

}  // namespace

Result<void> validate(const calibration::Calibration& c) {
  if (!fit::method_from(c.method)) return invalid(fmt::format("there is no method '{}'", c.method));
  for (int i = 0; i < static_cast<int>(c.sensors.size()); ++i) {
    if (auto ok = validate(c.sensors[static_cast<std::size_t>(i)], i + 1); !ok) return ok;
  }
  if (const auto baseline_m = c.geometry.cross_baseline_m(); baseline_m && !(*baseline_m > 0))
    return invalid(fmt::format("a baseline of {:g} m", *baseline_m));
  if ((c.sample_noise_nT.array() < 0).any() || (c.pose_noise_nT.array() < 0).any())
    return invalid("a noise is below zero");
  if (!c.reference.t_utc.empty() && !parse_utc(c.reference.t_utc))
    return invalid(fmt::format("'{}' is no time", c.reference.t_utc));
  if (auto ok = validate_effects(c); !ok) return ok;
  return validate_covariance(c);
}

}  // namespace mgtd::calib::validity
