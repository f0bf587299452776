// SPDX-License-Identifier: Apache-2.0
#include "calib/poses/table_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace mgtd::calib::poses {
namespace {

constexpr double kJump_rad = 0.35;  // no table turns so far from one reading to the next
constexpr std::size_t kFewest = 4;  // of a pchip

/// `angle` plus full turns, as close to `before` as they bring it.
double continued(double before_rad, double angle_rad) {
  return before_rad + std::remainder(angle_rad - before_rad, 2 * std::numbers::pi);
}

}  // namespace

TablePath::TablePath(std::span<const PathPoint> readings) {
  std::vector<PathPoint> stretch;
  for (PathPoint point : readings) {
    if (!stretch.empty()) {
      const PathPoint& last = stretch.back();
      if (!(point.t_s > last.t_s)) continue;
      point.angles.azimuth_rad = continued(last.angles.azimuth_rad, point.angles.azimuth_rad);
      point.angles.roll_rad = continued(last.angles.roll_rad, point.angles.roll_rad);
      if (std::max({std::abs(point.angles.azimuth_rad - last.angles.azimuth_rad),
                    std::abs(point.angles.pitch_rad - last.angles.pitch_rad),
                    std::abs(point.angles.roll_rad - last.angles.roll_rad)}) > kJump_rad) {
        add(stretch);
        stretch.clear();
      }
    }
    stretch.push_back(point);
  }
  add(stretch);
}

void TablePath::add(std::span<const PathPoint> stretch) {
  if (stretch.size() < kFewest) return;
  const auto curve = [&](double TableAngles::*angle) {
    std::vector<double> t_s, rad;
    for (const PathPoint& point : stretch) t_s.push_back(point.t_s), rad.push_back(point.angles.*angle);
    return Curve(std::move(t_s), std::move(rad), std::numeric_limits<double>::quiet_NaN(), 0.0);
  };
  stretches_.push_back({stretch.front().t_s, stretch.back().t_s, curve(&TableAngles::azimuth_rad),
                        curve(&TableAngles::pitch_rad), curve(&TableAngles::roll_rad)});
}

std::optional<TableAngles> TablePath::at(double t_s) const {
  for (const Stretch& s : stretches_) {
    if (t_s >= s.begin_s && t_s <= s.end_s)
      return TableAngles{s.azimuth_rad(t_s), s.pitch_rad(t_s), s.roll_rad(t_s)};
  }
  return std::nullopt;
}

}  // namespace mgtd::calib::poses
