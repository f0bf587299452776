// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/tensor_uncertainty.h"

#include <Eigen/LU>

#include "calib/calibration/tensor.h"
#include "calib/fit/joint/pose_model.h"
#include "calib/linear/propagation.h"

namespace mgtd::calib::fit::joint {

Gradient calibration_tensor_sd(const PerSensor<sensor::SensorModel>& sensors,
                               const sensor::Geometry& geometry, const Eigen::MatrixXd& covariance,
                               double f_nT) {
  JointProblem problem;
  problem.geometry = geometry;
  JointState state;
  state.sensors = sensors;
  const PoseModel model(problem, state);
  const JointPose anywhere;  // without table angles: the field itself is given
  const auto rows = calibration::gradient_rows(geometry);
  PoseLinear linear;
  const int block = problem.slots().sensor_block();
  Eigen::Matrix<double, 6, 1> variance = Eigen::Matrix<double, 6, 1>::Zero();
  for (int direction = 0; direction < 6; ++direction) {
    Nuisance b = Nuisance::Zero();
    b[direction / 2] = direction % 2 == 0 ? f_nT : -f_nT;
    model.linearise(anywhere, b, linear);
    Eigen::MatrixXd J(6, block);
    for (int i = 0; i < problem.sensors(); ++i) {
      const sensor::SensorModel& sensor = sensors[static_cast<std::size_t>(i)];
      const Eigen::Matrix3d gain = sensor.R_PS() * sensor.response().inverse();
      J.middleCols<sensor::kSensorParameters>(sensor::kSensorParameters * i) =
          rows.middleCols<3>(3 * i) * gain * linear.d_sensor.middleRows<3>(3 * i);
    }
    variance += linear::propagated_variances(J, covariance.topLeftCorner(block, block)) / 6;
  }
  // NaN stays NaN: what the array cannot tell.
  const Eigen::Matrix<double, 6, 1> sd =
      (variance.array() < 0).select(Eigen::Array<double, 6, 1>::Zero(), variance.array()).sqrt();
  return {sd[0], sd[1], sd[2], sd[3], sd[4], sd[5]};
}

}  // namespace mgtd::calib::fit::joint
