// SPDX-License-Identifier: Apache-2.0
#include "calib/report/named_columns.h"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "calib/report/json_number.h"
#include "calib/sensor/channels.h"
#include "proto/units.h"

namespace mgtd::calib::report {
namespace {

constexpr double kEmpty = std::numeric_limits<double>::quiet_NaN();

}  // namespace

std::vector<std::string> channel_names(Eigen::Index channels) {
  std::vector<std::string> out;
  for (int c = 0; c < channels; ++c) out.push_back(sensor::channel_name(c));
  return out;
}

std::vector<std::string> sensor_names(Eigen::Index sensors) {
  std::vector<std::string> out;
  for (Eigen::Index i = 0; i < sensors; ++i) out.push_back(fmt::format("s{}", i + 1));
  return out;
}

void add_rows(const std::string& group, const std::vector<std::string>& names, const Eigen::MatrixXd& rows,
              std::vector<NamedColumn>& out) {
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    NamedColumn column{group, names[static_cast<std::size_t>(i)], {}};
    for (Eigen::Index k = 0; k < rows.cols(); ++k) column.values.push_back(rows(i, k));
    out.push_back(std::move(column));
  }
}

std::vector<NamedColumn> circumstance_columns(std::span<const Pose* const> poses,
                                              const std::vector<double>& t_h,
                                              const std::map<std::string, std::vector<double>>& columns,
                                              Eigen::Index sensors) {
  std::vector<NamedColumn> out;
  const auto add = [&](std::string group, std::string name, auto&& value) {
    NamedColumn column{std::move(group), std::move(name), {}};
    for (const Pose* pose : poses) column.values.push_back(value(*pose));
    out.push_back(std::move(column));
  };
  const auto angle = [&](std::string group, std::optional<double> Pose::*rad) {
    add(std::move(group), "", [rad](const Pose& pose) {
      const std::optional<double>& known = pose.*rad;
      return known ? to_deg(*known) : kEmpty;
    });
  };
  const auto whole = [&](std::string group, std::optional<int> Pose::*value) {
    add(std::move(group), "", [value](const Pose& pose) {
      const std::optional<int>& known = pose.*value;
      return known ? static_cast<double>(*known) : kEmpty;
    });
  };
  whole("mount", &Pose::mount);
  whole("sense", &Pose::sense);
  out.push_back({"t_h", "", t_h});
  angle("azimuth_deg", &Pose::azimuth_rad);
  angle("pitch_deg", &Pose::pitch_rad);
  angle("roll_deg", &Pose::roll_rad);
  const std::vector<std::string> names = sensor_names(sensors);
  for (std::size_t s = 0; s < names.size(); ++s)
    add("T_degC", names[s], [s](const Pose& pose) { return pose.T_degC[s].value_or(kEmpty); });
  for (const auto& [name, values] : columns) out.push_back({"columns", name, values});
  return out;
}

void put_columns(const std::vector<NamedColumn>& columns, nlohmann::json& out) {
  for (const NamedColumn& column : columns) {
    nlohmann::json values = nlohmann::json::array();
    for (const double value : column.values) values.push_back(number_or_null(value));
    if (column.name.empty()) {
      out[column.group] = std::move(values);
    } else {
      out[column.group][column.name] = std::move(values);
    }
  }
}

}  // namespace mgtd::calib::report
