// SPDX-License-Identifier: Apache-2.0
#include "calib/report/residual_columns_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "calib/report/named_columns.h"

namespace mgtd::calib::report {
namespace {

using criticism::tests::ResidualColumns;
using nlohmann::json;

std::vector<NamedColumn> columns_of(const ResidualColumns& p) {
  const Eigen::Index sensors = p.scalar_nT.rows();
  std::vector<NamedColumn> out = circumstance_columns(p.pose, p.t_h, p.columns, sensors);
  const std::vector<std::string> channels = channel_names(p.residual_nT.rows()), axes{"x", "y", "z"};
  add_rows("residual_nT", channels, p.residual_nT, out);
  add_rows("whitened", channels, p.whitened, out);
  add_rows("scalar_nT", sensor_names(sensors), p.scalar_nT, out);
  add_rows("attitude_deg", axes, p.attitude_deg, out);
  add_rows("closure", p.closure_names, p.closure_nT, out);
  add_rows("direction_S", channels, p.direction_S, out);
  NamedColumn leverage{"leverage", "", {}}, shift{"tensor_shift_nT_per_m", "", {}};
  for (const fit::joint::PoseInfluence& influence : p.influence) {
    leverage.values.push_back(influence.leverage);
    shift.values.push_back(influence.tensor_shift_nT_per_m);
  }
  out.push_back(std::move(leverage));
  out.push_back(std::move(shift));
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

json to_json(const ResidualColumns& p) {
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
  put_columns(columns_of(p), out);
  return out;
}

std::string to_csv(const ResidualColumns& p) {
  const std::vector<NamedColumn> columns = columns_of(p);
  std::string out = "pose,set,left_out,tensor_shift_component";
  for (const NamedColumn& c : columns) {
    const std::string name = c.name.empty()         ? c.group
                             : c.group == "columns" ? c.name
                                                    : fmt::format("{} {}", c.group, c.name);
    out += "," + csv_cell(name);
  }
  out += "\n";
  for (std::size_t k = 0; k < p.pose.size(); ++k) {
    out += fmt::format("{},{},{},{}", p.pose[k]->number, csv_cell(p.pose[k]->set),
                       fmt::join(p.left_out[k], " "), p.influence[k].component);
    for (const NamedColumn& c : columns)
      out += std::isfinite(c.values[k]) ? fmt::format(",{}", c.values[k]) : ",";
    out += "\n";
  }
  return out;
}

}  // namespace mgtd::calib::report
