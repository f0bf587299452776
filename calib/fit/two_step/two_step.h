// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "calib/fit/readings.h"
#include "calib/fit/two_step/azimuth_origin.h"
#include "calib/fit/two_step/step2.h"
#include "calib/sensor/step1.h"

/// two_step() carries out both steps of the two-step method and gives the estimate alone, without its
/// uncertainty.
namespace mgtd::calib::fit::two_step {

struct TwoStep {
  PerSensor<sensor::ScalarCalibration> step1;
  Alignment alignment;  ///< in the gauge of `origin`
  AzimuthOrigin origin;
  PerSensor<sensor::SensorModel> sensors;

  /// Unit vector of the field in the platform frame at zero table angles.
  [[nodiscard]] Eigen::Vector3d site_direction() const;
};

/// `options.method` decides about step 1 only. Refusals name the sensor.
[[nodiscard]] Result<TwoStep> two_step(const Readings& readings, const FitOptions& options);

}  // namespace mgtd::calib::fit::two_step
