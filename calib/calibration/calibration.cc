// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration/calibration.h"

#include "calib/calibration/calibration_json.h"

namespace mgtd::calib::calibration {

void Calibration::seal() { id = content_id(to_json(*this)); }

Eigen::MatrixXd full_covariance(const Calibration& c) {
  const Eigen::Index m = c.effect_covariance.rows(), n = kArrayParameters + m;
  Eigen::MatrixXd out(n, n);
  out.topLeftCorner<kArrayParameters, kArrayParameters>() = c.covariance;
  if (m == 0) return out;  // then it may have no columns either
  out.bottomRows(m) = c.effect_covariance;
  out.topRightCorner(kArrayParameters, m) = c.effect_covariance.leftCols<kArrayParameters>().transpose();
  return out;
}

}  // namespace mgtd::calib::calibration
