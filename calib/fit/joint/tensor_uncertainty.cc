// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/tensor_uncertainty.h"

#include <cmath>
#include <limits>

#include "calib/calibration/tensor.h"
#include "calib/fit/joint/field_response.h"
#include "calib/linear/propagation.h"

namespace mgtd::calib::fit::joint {
namespace {

using Components = Eigen::Matrix<double, 6, 1>;

/// NaN stays NaN: what the array cannot tell.
Gradient component_roots(const Components& variance) {
  const Components sd =
      (variance.array() < 0).select(Eigen::Array<double, 6, 1>::Zero(), variance.array()).sqrt();
  return {sd[0], sd[1], sd[2], sd[3], sd[4], sd[5]};
}

}  // namespace

TensorResponse::TensorResponse(const PerSensor<sensor::SensorModel>& sensors,
                               const sensor::Geometry& geometry, double f_nT) {
  const auto rows = calibration::gradient_rows(geometry);
  const auto responses = field_responses(sensors, f_nT);
  const auto n = static_cast<Eigen::Index>(sensors.size());
  for (std::size_t direction = 0; direction < responses.size(); ++direction) {
    Eigen::MatrixXd& J = by_parameters_[direction];
    J.resize(6, sensor::kSensorParameters * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const FieldResponse& response = responses[direction][static_cast<std::size_t>(i)];
      J.middleCols<sensor::kSensorParameters>(sensor::kSensorParameters * i) =
          rows.middleCols<3>(3 * i) * response.gain * response.by_parameters;
    }
  }
}

Gradient TensorResponse::sd(const Eigen::MatrixXd& covariance) const {
  const Eigen::Index block = by_parameters_.front().cols();
  Components variance = Components::Zero();
  for (const Eigen::MatrixXd& J : by_parameters_)
    variance += linear::propagated_variances(J, covariance.topLeftCorner(block, block)) / 6;
  return component_roots(variance);
}

Gradient TensorResponse::shift(const Eigen::VectorXd& step) const {
  Components squares = Components::Zero();
  for (const Eigen::MatrixXd& J : by_parameters_) squares += (J * step.head(J.cols())).cwiseAbs2() / 6;
  return component_roots(squares);
}

Gradient calibration_tensor_sd(const PerSensor<sensor::SensorModel>& sensors,
                               const sensor::Geometry& geometry, const Eigen::MatrixXd& covariance,
                               double f_nT) {
  return TensorResponse(sensors, geometry, f_nT).sd(covariance);
}

WorstComponent worst_component(const Gradient& g) {
  static constexpr std::array<const char*, 6> kNames{"xx", "yy", "zz", "xy", "xz", "yz"};
  WorstComponent out{.value = std::numeric_limits<double>::quiet_NaN()};
  const auto values = components(g);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isnan(values[i]) && !(values[i] <= out.value)) out = {values[i], kNames[i]};
  return out;
}

}  // namespace mgtd::calib::fit::joint
