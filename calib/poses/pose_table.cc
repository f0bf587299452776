// SPDX-License-Identifier: Apache-2.0
#include "calib/poses/pose_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "calib/poses/pose_columns.h"
#include "calib/poses/pose_list.h"
#include "calib/poses/pose_table_reader.h"
#include "calib/poses/table_text.h"
#include "proto/sha256.h"

namespace mgtd::calib::poses {

Result<PoseTable> parse_pose_table(std::string_view text, std::string_view file, std::string_view map) {
  return PoseTableReader(text, file, PoseTableReader::Rows::measured, kSensorCount, map).read();
}

Result<PoseTable> parse_pose_list(std::string_view text, std::string_view file, std::size_t sensors) {
  return PoseTableReader(text, file, PoseTableReader::Rows::planned, sensors).read();
}

Result<PoseList> read_pose_list(std::string_view text, std::string_view file) {
  PoseTableReader reader(text, file, PoseTableReader::Rows::planned, kSensorCount);
  auto table = reader.read();
  if (!table) return tl::unexpected(table.error());
  return PoseList{*std::move(table), reader.lines(), reader.notes()};
}

std::string format_pose_table(const PoseTable& table) {
  const auto any = [&](const auto& has) { return std::any_of(table.poses.begin(), table.poses.end(), has); };
  const bool with_utc = any([](const Pose& p) { return p.t_utc.has_value(); });
  std::vector<const PoseColumn*> columns;
  for (const PoseColumn& column : pose_columns(sensors_of(table))) {
    if (any([&](const Pose& p) { return column.get(p).has_value(); })) columns.push_back(&column);
  }
  std::set<std::string> covariates;
  for (const Pose& pose : table.poses) {
    for (const auto& [name, value] : pose.covariates) covariates.insert(name);
  }
  std::string out = with_utc ? "pose,set,t_utc" : "pose,set";
  for (const PoseColumn* column : columns) out += "," + column->name;
  for (const std::string& name : covariates) out += "," + cell_text(name);
  out += "\n";
  for (const Pose& pose : table.poses) {
    out += fmt::format("{},{}", pose.number, cell_text(pose.set));
    if (with_utc) out += "," + (pose.t_utc ? format_utc(*pose.t_utc) : std::string{});
    for (const PoseColumn* column : columns) {
      const auto value = column->get(pose);
      out += value ? fmt::format(",{}", *value) : ",";
    }
    for (const std::string& name : covariates) {
      const auto found = pose.covariates.find(name);
      out += found == pose.covariates.end() ? "," : fmt::format(",{}", found->second);
    }
    out += "\n";
  }
  return out;
}

std::string data_hash(const PoseTable& table) { return sha256_hex(format_pose_table(table)); }

}  // namespace mgtd::calib::poses
