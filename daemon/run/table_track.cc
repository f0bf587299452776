// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/table_track.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mgtd::daemon::run {
namespace {

constexpr double kSamePlace_rad = 1e-5;
constexpr double kElsewhere_rad = 1e-3;

bool same_state(const TableReading& a, const TableReading& b) {
  return a.moving == b.moving && a.on_target == b.on_target && a.referenced == b.referenced &&
         furthest_rad(a.angles, b.angles) < kSamePlace_rad;
}

}  // namespace

double furthest_rad(const TableAngles& a, const TableAngles& b) {
  return std::max({std::abs(a.azimuth_rad - b.azimuth_rad), std::abs(a.pitch_rad - b.pitch_rad),
                   std::abs(a.roll_rad - b.roll_rad)});
}

void TableTrack::add(const TableReading& reading, const std::optional<TableAngles>& recorded) {
  if (recorded && (!latest_ || !same_state(*latest_, reading))) {
    path_.push_back(reading);
    path_.back().angles = *recorded;
  }
  if (reading.moving || (rest_ && furthest_rad(rest_->angles, reading.angles) > kElsewhere_rad))
    rest_.reset();
  if (!reading.moving && !rest_) rest_ = reading;
  if (!reading.referenced) referenced_ = false;
  latest_ = reading;
}

void TableTrack::lost() {
  latest_.reset();
  rest_.reset();
  referenced_ = false;
}

std::optional<Instant> TableTrack::rests_since() const {
  if (!rest_) return std::nullopt;
  return rest_->arrival.mono;
}

std::vector<TableReading> TableTrack::take_path() { return std::exchange(path_, {}); }

}  // namespace mgtd::daemon::run
