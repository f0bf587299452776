// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/field_uncertainty.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "calib/fit/joint/pose_model.h"

namespace mgtd::calib::fit::joint {

double calibration_field_sd_nT(const PerSensor<sensor::SensorModel>& sensors,
                               const Eigen::MatrixXd& covariance, double f_nT) {
  constexpr int kDirections = 6;
  constexpr int kOwn = sensor::kSensorParameters;
  JointProblem problem;
  problem.geometry = sensor::Geometry(PerSensor<Eigen::Vector3d>(sensors.size(), Eigen::Vector3d::Zero()));
  JointState state;
  state.sensors = sensors;
  const PoseModel model(problem, state);
  const JointPose anywhere;  // without table angles: the field itself is given
  PoseLinear linear;
  double variance = 0;
  for (int direction = 0; direction < kDirections; ++direction) {
    Nuisance b = Nuisance::Zero();
    b[direction / 2] = direction % 2 == 0 ? f_nT : -f_nT;
    model.linearise(anywhere, b, linear);
    for (int i = 0; i < problem.sensors(); ++i) {
      const sensor::SensorModel& sensor = sensors[static_cast<std::size_t>(i)];
      const Eigen::Matrix<double, 3, kOwn> J =
          sensor.R_PS() * sensor.response().inverse() * linear.d_sensor.middleRows<3>(3 * i);
      variance += (J * covariance.block<kOwn, kOwn>(kOwn * i, kOwn * i) * J.transpose()).trace();
    }
  }
  return std::sqrt(std::max(0.0, variance) / (kDirections * problem.channels()));
}

}  // namespace mgtd::calib::fit::joint
