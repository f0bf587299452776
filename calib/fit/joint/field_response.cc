// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/field_response.h"

#include <Eigen/LU>

#include "calib/fit/joint/pose_model.h"

namespace mgtd::calib::fit::joint {

std::array<PerSensor<FieldResponse>, 6> field_responses(const PerSensor<sensor::SensorModel>& sensors,
                                                        double f_nT) {
  JointProblem problem;
  problem.geometry = sensor::Geometry(PerSensor<Eigen::Vector3d>(sensors.size(), Eigen::Vector3d::Zero()));
  JointState state;
  state.sensors = sensors;
  const PoseModel model(problem, state);
  const JointPose anywhere;  // without table angles: the field itself is given
  PoseLinear linear;
  std::array<PerSensor<FieldResponse>, 6> out;
  out.fill(PerSensor<FieldResponse>(sensors.size()));
  for (std::size_t direction = 0; direction < out.size(); ++direction) {
    Nuisance b = Nuisance::Zero();
    b[static_cast<Eigen::Index>(direction / 2)] = direction % 2 == 0 ? f_nT : -f_nT;
    model.linearise(anywhere, b, linear);
    for (int i = 0; i < problem.sensors(); ++i) {
      const sensor::SensorModel& sensor = sensors[static_cast<std::size_t>(i)];
      out[direction][static_cast<std::size_t>(i)] = {sensor.R_PS() * sensor.response().inverse(),
                                                     linear.d_sensor.middleRows<3>(3 * i)};
    }
  }
  return out;
}

}  // namespace mgtd::calib::fit::joint
