// SPDX-License-Identifier: Apache-2.0
#include "daemon/plan/approach.h"

#include <cmath>

#include "proto/units.h"

namespace mgtd::daemon::plan {
namespace {

constexpr double kSameAzimuth_rad = to_rad(0.2);
constexpr double kLimitTolerance_rad = 1e-9;

bool inside(const drivers::TableLimits::Range& range, double a_rad) {
  return a_rad >= range.min_rad - kLimitTolerance_rad && a_rad <= range.max_rad + kLimitTolerance_rad;
}

}  // namespace

bool inside(const drivers::TableLimits& limits, const TableAngles& a) {
  return inside(limits.azimuth, a.azimuth_rad) && inside(limits.pitch, a.pitch_rad) &&
         inside(limits.roll, a.roll_rad);
}

int sense_of(double from_rad, double to_rad) {
  if (std::abs(to_rad - from_rad) < kSameAzimuth_rad) return 0;
  return to_rad > from_rad ? +1 : -1;
}

int possible_sense(int wished, const TableAngles& target, const drivers::TableLimits& limits) {
  TableAngles before = target;
  before.azimuth_rad -= wished * kApproach_rad;
  return inside(limits, before) ? wished : -wished;
}

std::optional<TableAngles> waypoint(const TableAngles& from, int last_sense, const TableAngles& target,
                                    int sense, double approach_rad, const drivers::TableLimits& limits) {
  if (sense == 0 || approach_rad <= 0) return std::nullopt;
  const int natural = sense_of(from.azimuth_rad, target.azimuth_rad);
  if (natural == sense || (natural == 0 && last_sense == sense)) return std::nullopt;
  TableAngles before = target;
  before.azimuth_rad -= sense * approach_rad;
  if (!inside(limits, before)) return std::nullopt;
  return before;
}

}  // namespace mgtd::daemon::plan
