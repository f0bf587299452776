// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/pose_row.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>

namespace mgtd::daemon::store {
namespace {

using calib::poses::PoseColumn;
using PoseAngle = std::optional<double> Pose::*;

PoseColumn stored_column(const PoseColumn& column) {
  static const std::map<std::string, std::pair<std::string, PoseAngle>, std::less<>> kAngles{
      {"azimuth_deg", {"azimuth_rad", &Pose::azimuth_rad}},
      {"pitch_deg", {"pitch_rad", &Pose::pitch_rad}},
      {"roll_deg", {"roll_rad", &Pose::roll_rad}}};
  const auto found = kAngles.find(column.name);
  if (found == kAngles.end()) return column;
  const std::string& name = found->second.first;
  const PoseAngle angle_rad = found->second.second;
  return {name, false, [angle_rad](Pose& pose, double rad) { pose.*angle_rad = rad; },
          [angle_rad](const Pose& pose) { return pose.*angle_rad; }};
}

std::vector<PoseColumn> make(std::size_t sensors) {
  std::vector<PoseColumn> columns;
  for (const PoseColumn& column : calib::poses::pose_columns(sensors))
    if (!column.name.starts_with("ref_")) columns.push_back(stored_column(column));
  std::stable_partition(columns.begin(), columns.end(), [](const PoseColumn& column) {
    return !(column.name.starts_with('s') && column.name.size() > 1 && column.name[1] >= '0' &&
             column.name[1] <= '9');
  });
  return columns;
}

}  // namespace

const std::vector<PoseColumn>& stored_columns(std::size_t sensors) {
  static const auto kColumns = [] {
    std::array<std::vector<PoseColumn>, kMostSensors + 1> all;
    for (std::size_t n = 0; n < all.size(); ++n) all[n] = make(n);
    return all;
  }();
  return kColumns.at(sensors);
}

}  // namespace mgtd::daemon::store
