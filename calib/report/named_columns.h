// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "proto/pose.h"

/// These functions write values by pose as JSON, one array for each column.
namespace mgtd::calib::report {

/// A column: its group ("residual_nT"), its name in the group ("s1.x"; empty: the group is one column), and
/// its values.
struct NamedColumn {
  std::string group, name;
  std::vector<double> values;
};

/// "s1.x", "s1.y", ...
[[nodiscard]] std::vector<std::string> channel_names(Eigen::Index channels);
/// "s1", "s2", ...
[[nodiscard]] std::vector<std::string> sensor_names(Eigen::Index sensors);

/// One column for each row of a matrix.
void add_rows(const std::string& group, const std::vector<std::string>& names, const Eigen::MatrixXd& rows,
              std::vector<NamedColumn>& out);

/// What stands beside the readings of a pose: mount, sense, time, angles, temperatures, extra columns.
[[nodiscard]] std::vector<NamedColumn> circumstance_columns(
    std::span<const Pose* const> poses, const std::vector<double>& t_h,
    const std::map<std::string, std::vector<double>>& columns, Eigen::Index sensors);

/// {"t_h": [..], "residual_nT": {"s1.x": [..], ..}}; what is not finite is null.
void put_columns(const std::vector<NamedColumn>& columns, nlohmann::json& out);

}  // namespace mgtd::calib::report
