// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/pose_writer.h"

#include <fmt/format.h>

#include <iterator>
#include <optional>
#include <set>

#include "tests/rig/rotations.h"

namespace mgtd::rig {
namespace {

using Buffer = fmt::memory_buffer;

std::set<std::string> covariates(const PoseTable& table) {
  std::set<std::string> out;
  for (const Pose& pose : table.poses)
    for (const auto& [name, value] : pose.covariates) out.insert(name);
  return out;
}

bool remounted(const PoseTable& table) {
  return !table.poses.empty() && table.poses.front().mount.has_value();
}

void header(Buffer& out, const PoseTable& table) {
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "pose,set,t_s,azimuth_deg,pitch_deg,roll_deg,f_nT,f_sd_nT,n,n_eff");
  for (int i = 1; i <= kSensors; ++i) fmt::format_to(to, ",s{0}_x_nT,s{0}_y_nT,s{0}_z_nT", i);
  for (int i = 1; i <= kSensors; ++i) fmt::format_to(to, ",s{0}_sd_x_nT,s{0}_sd_y_nT,s{0}_sd_z_nT", i);
  for (int i = 1; i <= kSensors; ++i) fmt::format_to(to, ",s{}_T_degC", i);
  fmt::format_to(to, ",sense,dwell_s,since_stop_s");
  if (remounted(table)) fmt::format_to(to, ",mount");
  for (const std::string& name : covariates(table)) fmt::format_to(to, ",{}", name);
  out.push_back('\n');
}

template <class Number>
void cell(Buffer& out, const std::optional<Number>& value, int decimals, double factor = 1) {
  out.push_back(',');
  if (value)
    fmt::format_to(std::back_inserter(out), "{:.{}f}", static_cast<double>(*value) * factor, decimals);
}

void row(Buffer& out, const Pose& pose, const std::set<std::string>& names, bool with_mount) {
  fmt::format_to(std::back_inserter(out), "{},{}", pose.number, pose.set);
  cell(out, pose.t_s, 3);
  for (const auto& angle : {pose.azimuth_rad, pose.pitch_rad, pose.roll_rad}) cell(out, angle, 6, 1 / kDeg);
  cell(out, pose.f_nT, 4);
  cell(out, pose.f_sd_nT, 4);
  cell(out, pose.n, 0);
  cell(out, pose.n_eff, 1);
  for (const auto& y : pose.y_nT)
    for (int a = 0; a < 3; ++a) cell(out, std::optional(y[a]), 5);
  for (const auto& sensor : pose.sd_nT)
    for (const auto& sd : sensor) cell(out, sd, 5);
  for (const auto& T : pose.T_degC) cell(out, T, 4);
  cell(out, pose.sense, 0);
  cell(out, pose.dwell_s, 1);
  cell(out, pose.since_stop_s, 3);
  if (with_mount) cell(out, pose.mount, 0);
  for (const std::string& name : names) {
    const auto found = pose.covariates.find(name);
    cell(out, found == pose.covariates.end() ? std::optional<double>() : found->second, 5);
  }
  out.push_back('\n');
}

}  // namespace

std::string pose_table_csv(const PoseTable& table) {
  Buffer out;
  header(out, table);
  const auto names = covariates(table);
  for (const Pose& pose : table.poses) row(out, pose, names, remounted(table));
  return fmt::to_string(out);
}

}  // namespace mgtd::rig
