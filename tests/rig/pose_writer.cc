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

std::set<std::string> covariates(const Survey& survey) {
  std::set<std::string> out;
  for (const SurveyRow& row : survey.rows)
    for (const auto& [name, value] : row.covariates) out.insert(name);
  return out;
}

/// Which columns there are.
struct Columns {
  explicit Columns(const Survey& survey)
      : sensors(survey.sensors),
        dwells(survey.dwells),
        turned(survey.turned),
        angles(survey.angles),
        scalar(survey.scalar),
        reference(!survey.rows.empty() && survey.rows.front().ref_nT.has_value()),
        mount(!survey.rows.empty() && survey.rows.front().mount.has_value()),
        names(covariates(survey)) {}
  std::size_t sensors;
  bool dwells, turned, angles, scalar, reference, mount;
  std::set<std::string> names;
};

void header(Buffer& out, const Columns& columns) {
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "pose{},t_s", columns.dwells ? ",set" : "");
  if (columns.angles) fmt::format_to(to, ",azimuth_deg,pitch_deg,roll_deg");
  if (columns.scalar) fmt::format_to(to, ",f_nT{}", columns.dwells ? ",f_sd_nT" : "");
  if (columns.dwells) fmt::format_to(to, ",n,n_eff");
  if (columns.reference) fmt::format_to(to, ",ref_x_nT,ref_y_nT,ref_z_nT,ref_sd_nT");
  for (std::size_t i = 1; i <= columns.sensors; ++i) fmt::format_to(to, ",s{0}_x_nT,s{0}_y_nT,s{0}_z_nT", i);
  if (columns.dwells) {
    for (std::size_t i = 1; i <= columns.sensors; ++i)
      fmt::format_to(to, ",s{0}_sd_x_nT,s{0}_sd_y_nT,s{0}_sd_z_nT", i);
    for (std::size_t i = 1; i <= columns.sensors; ++i) fmt::format_to(to, ",s{}_T_degC", i);
  }
  if (columns.turned) fmt::format_to(to, ",sense");
  if (columns.dwells) fmt::format_to(to, ",dwell_s");
  if (columns.turned) fmt::format_to(to, ",since_stop_s");
  if (columns.mount) fmt::format_to(to, ",mount");
  for (const std::string& name : columns.names) fmt::format_to(to, ",{}", name);
  out.push_back('\n');
}

template <class Number>
void cell(Buffer& out, const std::optional<Number>& value, int decimals, double factor = 1) {
  out.push_back(',');
  if (value)
    fmt::format_to(std::back_inserter(out), "{:.{}f}", static_cast<double>(*value) * factor, decimals);
}

void readings(Buffer& out, const SurveyRow& row, const Columns& columns) {
  for (const auto& y : row.y_nT)
    for (int a = 0; a < 3; ++a) cell(out, std::optional(y[a]), 5);
  if (!columns.dwells) return;
  for (const auto& sensor : row.sd_nT)
    for (const auto& sd : sensor) cell(out, sd, 5);
  for (const auto& T : row.T_degC) cell(out, T, 4);
}

void write(Buffer& out, const SurveyRow& row, const Columns& columns) {
  fmt::format_to(std::back_inserter(out), "{}", row.number);
  if (columns.dwells) fmt::format_to(std::back_inserter(out), ",{}", row.set);
  cell(out, row.t_s, columns.dwells ? 3 : 6);
  if (columns.angles) {
    for (const auto& angle : {row.azimuth_rad, row.pitch_rad, row.roll_rad}) cell(out, angle, 6, 1 / kDeg);
  }
  if (columns.scalar) cell(out, row.f_nT, 4);
  if (columns.scalar && columns.dwells) cell(out, row.f_sd_nT, 4);
  if (columns.dwells) {
    cell(out, row.n, 0);
    cell(out, row.n_eff, 1);
  }
  if (columns.reference) {
    for (int a = 0; a < 3; ++a) cell(out, row.ref_nT ? std::optional((*row.ref_nT)[a]) : std::nullopt, 5);
    cell(out, row.ref_sd_nT, 4);
  }
  readings(out, row, columns);
  if (columns.turned) cell(out, row.sense, 0);
  if (columns.dwells) cell(out, row.dwell_s, 1);
  if (columns.turned) cell(out, row.since_stop_s, 3);
  if (columns.mount) cell(out, row.mount, 0);
  for (const std::string& name : columns.names) {
    const auto found = row.covariates.find(name);
    cell(out, found == row.covariates.end() ? std::optional<double>() : found->second, 5);
  }
  out.push_back('\n');
}

}  // namespace

std::string pose_table_csv(const Survey& survey) {
  Buffer out;
  const Columns columns(survey);
  header(out, columns);
  for (const SurveyRow& row : survey.rows) write(out, row, columns);
  return fmt::to_string(out);
}

std::string pose_table_csv(const PoseTable& table) { return pose_table_csv(survey_of(table)); }

}  // namespace mgtd::rig
