// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <string>

#include "calib/sensor/geometry.h"
#include "calib/sensor/sensor_model.h"
#include "proto/tensor.h"

namespace mgtd::calib::fit::joint {

/// calibration_tensor_sd() gives the standard deviation of each component of the tensor, in a uniform field
/// of strength F, that follows from a covariance of the 12 parameters of each sensor: root mean square over
/// all attitudes, by what an error of the parameters makes of the corrected fields (field_response.h).
[[nodiscard]] Gradient calibration_tensor_sd(const PerSensor<sensor::SensorModel>& sensors,
                                             const sensor::Geometry& geometry,
                                             const Eigen::MatrixXd& covariance, double f_nT);

/// What a change of the 12 parameters a sensor makes of the tensor in a uniform field of strength F: the root
/// of the mean square of each component over all attitudes. NaN: the array cannot tell the component.
class TensorResponse {
 public:
  TensorResponse(const PerSensor<sensor::SensorModel>& sensors, const sensor::Geometry& geometry,
                 double f_nT);

  /// `step`: of the fixed block, or of its first 12 a sensor alone.
  [[nodiscard]] Gradient shift(const Eigen::VectorXd& step) const;
  [[nodiscard]] Gradient sd(const Eigen::MatrixXd& covariance) const;

 private:
  std::array<Eigen::MatrixXd, 6> by_parameters_;  ///< of the components, in one direction of the field each
};

/// The largest of the components that are no NaN; NaN without a name where there is none.
struct WorstComponent {
  double value{0};
  std::string name{};  ///< "xx", ...
};
[[nodiscard]] WorstComponent worst_component(const Gradient& g);

}  // namespace mgtd::calib::fit::joint
