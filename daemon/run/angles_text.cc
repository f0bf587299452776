// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/angles_text.h"

#include <fmt/format.h>

#include <cmath>

#include "proto/units.h"

namespace mgtd::daemon::run {
namespace {

/// -0 becomes 0.
double hundredths_deg(double angle_rad) { return std::round(100 * to_deg(angle_rad)) / 100 + 0.0; }

}  // namespace

std::string angles_text(const TableAngles& a) {
  return fmt::format("azimuth {:.2f}, pitch {:.2f}, roll {:.2f} deg", hundredths_deg(a.azimuth_rad),
                     hundredths_deg(a.pitch_rad), hundredths_deg(a.roll_rad));
}

}  // namespace mgtd::daemon::run
