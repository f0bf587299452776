// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "proto/pose.h"

/// A Survey is what the rig measured, row by row, with any number of sensors. The names and units are those
/// of the pose table; angles are radians. What was not measured is empty.
namespace mgtd::rig {

struct SurveyRow {
  explicit SurveyRow(std::size_t sensors) : y_nT(sensors), sd_nT(sensors), T_degC(sensors) {}

  int number{0};
  std::string set;
  std::optional<double> t_s;
  std::optional<double> azimuth_rad, pitch_rad, roll_rad;
  std::optional<double> f_nT, f_sd_nT;
  std::optional<Eigen::Vector3d> ref_nT;  ///< in the axes of the vector reference
  std::optional<double> ref_sd_nT;
  std::optional<double> n, n_eff;
  std::vector<Eigen::Vector3d> y_nT;
  std::vector<std::array<std::optional<double>, 3>> sd_nT;
  std::vector<std::optional<double>> T_degC;
  std::optional<int> mount, sense;
  std::optional<double> dwell_s, since_stop_s;
  std::map<std::string, double> covariates;
};

struct Survey {
  std::size_t sensors{0};
  std::vector<SurveyRow> rows;
  std::vector<PathPoint> path{};  ///< of the table, where it is recorded

  /// Which columns its table has.
  bool dwells{true};  ///< a row is the mean of a stay, not a sample
  bool turned{true};  ///< a table went from row to row
  bool angles{true}, scalar{true};
};

/// The same as the programs hold it.
[[nodiscard]] PoseTable pose_table_of(const Survey& survey);
[[nodiscard]] Survey survey_of(const PoseTable& table);

}  // namespace mgtd::rig
