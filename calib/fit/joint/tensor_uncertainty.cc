// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/tensor_uncertainty.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "calib/calibration/tensor.h"
#include "calib/fit/joint/pose_model.h"
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
  JointProblem problem;
  problem.geometry = geometry;
  JointState state;
  state.sensors = sensors;
  const PoseModel model(problem, state);
  const JointPose anywhere;  // without table angles: the field itself is given
  const auto rows = calibration::gradient_rows(geometry);
  PoseLinear linear;
  const int block = problem.slots().sensor_block();
  for (int direction = 0; direction < 6; ++direction) {
    Nuisance b = Nuisance::Zero();
    b[direction / 2] = direction % 2 == 0 ? f_nT : -f_nT;
    model.linearise(anywhere, b, linear);
    Eigen::MatrixXd& J = by_parameters_[static_cast<std::size_t>(direction)];
    J.resize(6, block);
    for (int i = 0; i < problem.sensors(); ++i) {
      const sensor::SensorModel& sensor = sensors[static_cast<std::size_t>(i)];
      const Eigen::Matrix3d gain = sensor.R_PS() * sensor.response().inverse();
      J.middleCols<sensor::kSensorParameters>(sensor::kSensorParameters * i) =
          rows.middleCols<3>(3 * i) * gain * linear.d_sensor.middleRows<3>(3 * i);
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
