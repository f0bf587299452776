// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "calib/fit/fit_options.h"
#include "proto/pose.h"

/// MeasuredColumns holds what was measured at each pose, column by column. It needs no fit, so it exists
/// where a fit is refused too.
namespace mgtd::calib::criticism::tests {

/// Columns of matrices are poses in the order of the table, without those of the set "check", as a fit has
/// them. NaN: not measured.
struct MeasuredColumns {
  std::vector<const Pose*> pose{};  ///< of the pose table
  std::vector<double> t_h{};
  std::map<std::string, std::vector<double>> columns{};  ///< every extra numeric column
  std::vector<double> f_nT{};   ///< total field: of the scalar reference, of a vector reference, or as given
  Eigen::MatrixXd reading_nT;   ///< 3N x P
  Eigen::MatrixXd spread_nT;    ///< N x P, of one sample within the dwell, rms over the axes
  Eigen::MatrixXd length_nT;    ///< N x P, of the three readings of a sensor
  Eigen::MatrixXd raw_nT;       ///< N x P, length less f_nT; without any field less the median of the sensor
  Eigen::MatrixXd direction_S;  ///< 3N x P, the readings of a sensor as unit vectors
  bool field_known{false};      ///< of any pose
};

/// `table` must outlive the result. Of `options` only the field that was given is used.
[[nodiscard]] MeasuredColumns measured_columns(const PoseTable& table, const fit::FitOptions& options);

/// Every extra numeric column of these poses, NaN where a pose has none.
[[nodiscard]] std::map<std::string, std::vector<double>> extra_columns(std::span<const Pose* const> poses);

}  // namespace mgtd::calib::criticism::tests
