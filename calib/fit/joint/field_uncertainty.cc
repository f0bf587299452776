// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/field_uncertainty.h"

#include <algorithm>
#include <cmath>

#include "calib/fit/joint/field_response.h"
#include "calib/linear/propagation.h"

namespace mgtd::calib::fit::joint {

double calibration_field_sd_nT(const PerSensor<sensor::SensorModel>& sensors,
                               const Eigen::MatrixXd& covariance, double f_nT) {
  constexpr int kOwn = sensor::kSensorParameters;
  const auto responses = field_responses(sensors, f_nT);
  double variance = 0;
  for (const PerSensor<FieldResponse>& direction : responses) {
    for (std::size_t i = 0; i < direction.size(); ++i) {
      const Eigen::Matrix<double, 3, kOwn> J = direction[i].gain * direction[i].by_parameters;
      const auto own = kOwn * static_cast<Eigen::Index>(i);
      variance += linear::propagated_variances(J, covariance.block<kOwn, kOwn>(own, own)).sum();
    }
  }
  const auto components = static_cast<double>(responses.size() * sensors.size() * 3);
  return std::sqrt(std::max(0.0, variance) / components);
}

}  // namespace mgtd::calib::fit::joint
