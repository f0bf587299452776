// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "proto/pose.h"

/// dwell_motion() estimates how far the field moves while the table stands still. A storm moves the readings
/// within a dwell as noise does, and the spread of the samples contains it; the mean of the dwell is compared
/// with the mean of the reference and does not.
///
/// No reference is known sample by sample. From one pose to the next (at most a minute) it moves at the rate
/// dB/dt, which in a dwell of length T spreads a component by |dB/dt| T / sqrt(12). Faster motion is missed,
/// so this is the least that the field moved. A gross reading of the reference, whose two moves are far
/// beyond the usual one and cancel, does not count.
namespace mgtd::calib::fit {

struct DwellMotion {
  double component_nT{
      0};              ///< root mean square over poses and components, the reference's own noise taken off
  bool vector{false};  ///< by the vector reference beside the table; else by f_nT, which shows the size alone
};

/// Empty where fewer than 12 pairs of poses have dwell_s, t_s and a reference.
[[nodiscard]] std::optional<DwellMotion> dwell_motion(const PoseTable& table);

}  // namespace mgtd::calib::fit
