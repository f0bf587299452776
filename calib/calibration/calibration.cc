// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration/calibration.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "calib/calibration/calibration_json.h"

namespace mgtd::calib::calibration {

void Calibration::seal() { id = content_id(to_json(*this)); }

double root_mean_square(const AxisNoise& noise_nT) {
  const auto axes = Eigen::Map<const Eigen::ArrayXd>(noise_nT.data(), noise_nT.size());
  return sensor::over_channels(axes.size(), [&](auto n) { return std::sqrt(axes.head(n).square().mean()); });
}

Eigen::MatrixXd full_covariance(const Calibration& c) {
  const Eigen::Index m = c.effect_covariance.rows(), p = c.covariance.rows(), n = p + m;
  Eigen::MatrixXd out(n, n);
  out.topLeftCorner(p, p) = c.covariance;
  if (m == 0) return out;  // then it may have no columns either
  out.bottomRows(m) = c.effect_covariance;
  out.topRightCorner(p, m) = c.effect_covariance.leftCols(p).transpose();
  return out;
}

}  // namespace mgtd::calib::calibration
