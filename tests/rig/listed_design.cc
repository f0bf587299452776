// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <map>
#include <sstream>

#include "tests/rig/simulated_table.h"

namespace mgtd::rig {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> out;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) out.push_back(cell);
  return out;
}

/// Empty cells leave `number` as it is.
bool read(const std::map<std::string, std::string>& row, const std::string& column, double& number) {
  const auto found = row.find(column);
  if (found == row.end() || found->second.empty()) return true;
  const std::string& text = found->second;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

ListedDesign listed_design(const std::string& csv) {
  ListedDesign out;
  std::istringstream in(csv);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> columns = cells_of(line);
  for (int number = 2; std::getline(in, line); ++number) {
    const std::vector<std::string> cells = cells_of(line);
    std::map<std::string, std::string> row;
    for (std::size_t i = 0; i < std::min(cells.size(), columns.size()); ++i) row[columns[i]] = cells[i];
    PlannedPose pose;
    double sense = 0, since_stop_s = 0;
    const bool good = row.contains("azimuth_deg") && read(row, "azimuth_deg", pose.angles_deg[0]) &&
                      read(row, "pitch_deg", pose.angles_deg[1]) &&
                      read(row, "roll_deg", pose.angles_deg[2]) && read(row, "sense", sense) &&
                      read(row, "dwell_s", pose.dwell_s) && pose.dwell_s > 0 &&
                      read(row, "since_stop_s", since_stop_s);
    if (!good) return {.design = {}, .error = "line " + std::to_string(number) + " is no pose of a list"};
    pose.sense = static_cast<int>(sense);
    pose.wait_s = std::max(0.0, since_stop_s - pose.dwell_s / 2 - out.design.settle_s);
    if (!row["set"].empty()) pose.set = row["set"];
    out.design.poses.push_back(std::move(pose));
  }
  if (out.design.poses.empty()) out.error = "it has no poses";
  return out;
}

}  // namespace mgtd::rig
