// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "calib/fit/joint/joint_fit.h"

/// ResidualFields holds the residuals of one fit, brought back to the field at each sensor in the platform
/// frame. Columns are poses; rows are channels, sensors or angles. A reading that the fit left out counts as
/// one without residual.
namespace mgtd::calib::criticism::tests {

struct ResidualFields {
  Eigen::MatrixXd whitened;      ///< 3N x P, reading less prediction in units of the noise of its pose mean
  Eigen::MatrixXd delta_nT;      ///< 3N x P, the same as a field, frame P
  Eigen::MatrixXd scalar_nT;     ///< N x P, |b| of each sensor less the field of the pose
  Eigen::MatrixXd attitude_deg;  ///< 3 x P, correction of the table angles; 0 without them
  Eigen::MatrixXd closure_nT;    ///< zero for any gradient; of the cross the curl over the baseline first
  std::vector<std::string> closure_names;  ///< of its rows; none where the array has no closure
  Eigen::MatrixXd field_S_nT;              ///< 3N x P, the predicted field in the frame of each sensor
};

[[nodiscard]] ResidualFields residual_fields(const fit::joint::JointFit& fit);

}  // namespace mgtd::calib::criticism::tests
