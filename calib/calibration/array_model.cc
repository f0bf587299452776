// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration/array_model.h"

#include <fmt/format.h>

#include <Eigen/LU>

#include "calib/calibration/field_derivative.h"
#include "calib/effects/library/library.h"
#include "calib/sensor/sensor_equations.h"

namespace mgtd::calib::calibration {
namespace {

constexpr int kMaxSteps = 60;
constexpr double kExact_nT = 1e-9;

/// x with x + term(x) = target.
Eigen::Vector3d undo(const Eigen::Vector3d& target, const auto& term) {
  Eigen::Vector3d x = target;
  for (int i = 0; i < kMaxSteps; ++i) {
    const Eigen::Vector3d next = target - term(x);
    const double change = (next - x).norm();
    x = next;
    if (change < kExact_nT) break;
  }
  return x;
}

using PlatformInput = Eigen::Matrix<double, 6, 1>;

/// Field and unit gravity; none where the attitude is unknown.
PlatformInput platform_input(const Eigen::Vector3d& b_P_nT, const std::optional<Eigen::Matrix3d>& R) {
  PlatformInput in = PlatformInput::Zero();
  in.head<3>() = b_P_nT;
  if (R) in.tail<3>() = R->col(2);
  return in;
}

}  // namespace

ArrayModel::ArrayModel(const PerSensor<sensor::SensorModel>& sensors, const sensor::Geometry& geometry,
                       const std::vector<effects::EffectPtr>& effects, Eigen::VectorXd coefficients)
    : effects_(effects),
      sensors_(sensors),
      positions_P_m_(geometry.positions_P_m()),
      table_(effects_, effects::Level::table),
      site_(effects_, effects::Level::site),
      platform_(effects_, effects::Level::platform),
      axis_(effects_, effects::Level::axis),
      coefficients_(std::move(coefficients)) {
  gain_.resize(sensors_.size());
  offset_nT_.resize(sensors_.size());
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    gain_[i] = sensors[i].R_PS() * sensors[i].response().inverse();
    offset_nT_[i] = sensors[i].offset_nT;
  }
}

Result<ArrayModel> ArrayModel::of(const Calibration& calibration) {
  std::vector<effects::EffectPtr> effects;
  std::vector<double> values;
  for (const CalibratedEffect& fitted : calibration.effects) {
    auto effect = effects::library::make_effect(fitted.effect, static_cast<int>(calibration.sensors.size()));
    if (!effect) return tl::unexpected(effect.error());
    if ((*effect)->coefficients().size() != fitted.coefficients.size()) {
      return fail(ErrorCode::bad_input,
                  fmt::format("{} has {} coefficients in this calibration and {} here", fitted.effect,
                              fitted.coefficients.size(), (*effect)->coefficients().size()),
                  "use the version of mgt that wrote the calibration, or fit again");
    }
    effects.push_back(*effect);
    for (const EffectCoefficient& c : fitted.coefficients) values.push_back(c.value);
  }
  return ArrayModel(
      calibration.sensors, calibration.geometry, effects,
      Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
}

sensor::FieldVector ArrayModel::correct(const effects::Conditions& at, const sensor::FieldVector& y_nT,
                                        const std::optional<Eigen::Matrix3d>& R) const {
  sensor::FieldVector out(y_nT.size());
  for (int i = 0; i < sensors(); ++i) {
    const auto s = static_cast<std::size_t>(i);
    Eigen::Vector3d v = y_nT.segment<3>(3 * i) - offset_nT_[s];
    if (!axis_.empty()) {
      v = undo(v, [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
        return axis_.value(at, i, {x.data(), 3}, coefficients_);
      });
    }
    Eigen::Vector3d b = gain_[s] * v;
    if (!platform_.empty()) {
      b = undo(b, [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
        const PlatformInput in = platform_input(x, R);
        return platform_.value(at, i, {in.data(), 6}, coefficients_);
      });
    }
    out.segment<3>(3 * i) = b;
  }
  return out;
}

sensor::FieldVector ArrayModel::site_field(const effects::Conditions& at, const Eigen::Matrix3d& R) const {
  sensor::FieldVector out = sensor::FieldVector::Zero(3 * sensors());
  for (int i = 0; i < sensors() && !site_.empty(); ++i) {
    const Eigen::Vector3d x_S_m = R.transpose() * positions_P_m_[static_cast<std::size_t>(i)];
    out.segment<3>(3 * i) = R * Eigen::Vector3d(site_.value(at, i, {x_S_m.data(), 3}, coefficients_));
  }
  return out;
}

Eigen::MatrixXd ArrayModel::derivative(const effects::Conditions& at, const sensor::FieldVector& b_P_nT,
                                       const std::optional<Eigen::Matrix3d>& R, bool site_removed) const {
  const Eigen::Index m = coefficients_.size(), parameters = sensors() * sensor::kSensorParameters;
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(3 * sensors(), parameters + m);
  for (int i = 0; i < sensors(); ++i) {
    const auto s = static_cast<std::size_t>(i);
    const Eigen::Vector3d b = b_P_nT.segment<3>(3 * i);
    d.block<3, sensor::kSensorParameters>(3 * i, sensor::kSensorParameters * i) =
        field_derivative(sensors_[s], b);
    auto columns = d.block(3 * i, parameters, 3, m);
    if (!axis_.empty()) {
      const Eigen::Vector3d v = sensors_[s].response() * sensors_[s].R_PS().transpose() * b;
      columns -= gain_[s] * axis_.sum(at, i, {v.data(), 3}, coefficients_).d_coefficient;
    }
    if (!platform_.empty()) {
      const PlatformInput in = platform_input(b, R);
      columns -= platform_.sum(at, i, {in.data(), 6}, coefficients_).d_coefficient;
    }
    if (site_removed && R) {
      const Eigen::Vector3d x_S_m = R->transpose() * positions_P_m_[s];
      columns -= *R * site_.sum(at, i, {x_S_m.data(), 3}, coefficients_).d_coefficient;
    }
  }
  return d;
}

Eigen::Matrix3d ArrayModel::attitude(const effects::Conditions& at) const {
  const TableAngles a = at.pose.angles().value_or(TableAngles{});
  std::array<double, 5> s{a.azimuth_rad, a.pitch_rad, a.roll_rad, 0, 0};
  if (!table_.empty()) {
    const effects::TermValue terms = table_.value(at, 0, s, coefficients_);
    for (std::size_t j = 0; j < s.size(); ++j) s[j] += terms[static_cast<Eigen::Index>(j)];
  }
  return sensor::table_rotation(s[0], s[1], s[2], s[3], s[4]);
}

}  // namespace mgtd::calib::calibration
