// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "calib/fit/joint/pose_influence.h"

/// ResidualColumns holds what a fit leaves at each pose, column by column, for plots and for a look at single
/// poses. Columns of matrices are poses in the order of the fit. NaN: not known, or left out by the fit.
namespace mgtd::calib::criticism::tests {

struct ResidualColumns {
  std::vector<const Pose*> pose{};  ///< of the pose table that was fitted
  std::vector<double> t_h{};
  std::map<std::string, std::vector<double>> columns{};  ///< every extra numeric column
  Eigen::MatrixXd residual_nT;   ///< 3N x P, reading less prediction; of a reading left out too
  Eigen::MatrixXd whitened;      ///< 3N x P, the same in units of the noise of its pose mean
  Eigen::MatrixXd scalar_nT;     ///< N x P, |b| less the field of the pose: blind to errors of angles
  Eigen::MatrixXd attitude_deg;  ///< 3 x P, correction of the table angles, axes of the platform
  Eigen::MatrixXd closure_nT;    ///< rows as in closure_names; zero for any gradient
  std::vector<std::string> closure_names{};
  Eigen::VectorXd closure_chi2;  ///< P, of the closure against the noise of its readings
  Eigen::MatrixXd direction_S;   ///< 3N x P, unit vectors of the field in the frame of each sensor
  std::vector<std::vector<std::string>> left_out{};  ///< OutlierNode::where
  std::vector<fit::joint::PoseInfluence> influence{};
};

/// Reading less prediction, of what the fit left out too: 3N x P.
[[nodiscard]] Eigen::MatrixXd residuals_nT(const fit::joint::JointFit& fit);

[[nodiscard]] Result<ResidualColumns> residual_columns(const fit::joint::JointFit& fit);

}  // namespace mgtd::calib::criticism::tests
