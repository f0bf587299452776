// SPDX-License-Identifier: Apache-2.0
#include "calib/report/pose_points_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "calib/report/json_number.h"
#include "calib/sensor/channels.h"

namespace mgtd::calib::report {
namespace {

using criticism::tests::PosePoints;
using nlohmann::json;

constexpr double kEmpty = std::numeric_limits<double>::quiet_NaN();

/// A column: its group ("residual_nT"), its name in the group ("s1.x"; empty: the group is one column), and
/// its values.
struct PointColumn {
  std::string group, name;
  std::vector<double> values;
};

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
              std::vector<PointColumn>& out) {
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    PointColumn column{group, names[static_cast<std::size_t>(i)], {}};
    for (Eigen::Index k = 0; k < rows.cols(); ++k) column.values.push_back(rows(i, k));
    out.push_back(std::move(column));
  }
}

std::vector<PointColumn> columns_of(const PosePoints& p) {
  std::vector<PointColumn> out;
  const auto add = [&](std::string group, std::string name, auto&& value) {
    PointColumn column{std::move(group), std::move(name), {}};
    for (std::size_t k = 0; k < p.pose.size(); ++k) column.values.push_back(value(k));
    out.push_back(std::move(column));
  };
  const auto angle = [&](std::string group, std::optional<double> Pose::*rad) {
    add(std::move(group), "", [&, rad](std::size_t k) {
      const std::optional<double>& known = p.pose[k]->*rad;
      return known ? to_deg(*known) : kEmpty;
    });
  };
  const auto whole = [&](std::string group, std::optional<int> Pose::*value) {
    add(std::move(group), "", [&, value](std::size_t k) {
      const std::optional<int>& known = p.pose[k]->*value;
      return known ? static_cast<double>(*known) : kEmpty;
    });
  };
  whole("mount", &Pose::mount);
  whole("sense", &Pose::sense);
  add("t_h", "", [&](std::size_t k) { return p.t_h[k]; });
  angle("azimuth_deg", &Pose::azimuth_rad);
  angle("pitch_deg", &Pose::pitch_rad);
  angle("roll_deg", &Pose::roll_rad);
  const Eigen::Index sensors = p.scalar_nT.rows();
  for (Eigen::Index i = 0; i < sensors; ++i) {
    const auto at = static_cast<std::size_t>(i);
    add("T_degC", sensor_names(sensors)[at],
        [&](std::size_t k) { return p.pose[k]->T_degC[at].value_or(kEmpty); });
  }
  for (const auto& [name, values] : p.columns) out.push_back({"columns", name, values});
  const std::vector<std::string> channels = channel_names(p.residual_nT.rows()), axes{"x", "y", "z"};
  add_rows("residual_nT", channels, p.residual_nT, out);
  add_rows("whitened", channels, p.whitened, out);
  add_rows("scalar_nT", sensor_names(sensors), p.scalar_nT, out);
  add_rows("attitude_deg", axes, p.attitude_deg, out);
  add_rows("closure", p.closure_names, p.closure_nT, out);
  add_rows("direction_S", channels, p.direction_S, out);
  add("leverage", "", [&](std::size_t k) { return p.influence[k].leverage; });
  add("tensor_shift_nT_per_m", "", [&](std::size_t k) { return p.influence[k].tensor_shift_nT_per_m; });
  return out;
}

/// A text as a cell of CSV.
std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + "\"";
}

}  // namespace

json to_json(const PosePoints& p) {
  json number = json::array(), set = json::array(), component = json::array();
  for (const Pose* pose : p.pose) {
    number.push_back(pose->number);
    set.push_back(pose->set);
  }
  for (const fit::joint::PoseInfluence& influence : p.influence)
    component.push_back(influence.component.empty() ? json() : json(influence.component));
  json out{{"pose", std::move(number)}, {"set", std::move(set)},
           {"left_out", p.left_out},    {"tensor_shift_component", std::move(component)},
           {"columns", json::object()}, {"closure", json::object()}};
  for (const PointColumn& column : columns_of(p)) {
    json values = json::array();
    for (const double value : column.values) values.push_back(number_or_null(value));
    if (column.name.empty()) {
      out[column.group] = std::move(values);
    } else {
      out[column.group][column.name] = std::move(values);
    }
  }
  return out;
}

std::string to_csv(const PosePoints& p) {
  const std::vector<PointColumn> columns = columns_of(p);
  std::string out = "pose,set,left_out,tensor_shift_component";
  for (const PointColumn& c : columns) {
    const std::string name = c.name.empty()         ? c.group
                             : c.group == "columns" ? c.name
                                                    : fmt::format("{} {}", c.group, c.name);
    out += "," + csv_cell(name);
  }
  out += "\n";
  for (std::size_t k = 0; k < p.pose.size(); ++k) {
    out += fmt::format("{},{},{},{}", p.pose[k]->number, csv_cell(p.pose[k]->set),
                       fmt::join(p.left_out[k], " "), p.influence[k].component);
    for (const PointColumn& c : columns)
      out += std::isfinite(c.values[k]) ? fmt::format(",{}", c.values[k]) : ",";
    out += "\n";
  }
  return out;
}

}  // namespace mgtd::calib::report
