// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "calib/effects/laws/readings_by_angles.h"
#include "proto/pose.h"

/// way_deviations() estimates how far the table stood off its angles on the way from one dwell to the next.
///
/// Known are, as well as the readings tell (readings_by_angles.h), the deviations at both dwells. Where an
/// axis turns back, nothing is known of any: the table ends one move there (it goes beyond the pose, to
/// arrive from the side that the backlash wants) and begins another. In between, when an axis has made the
/// share s of its way from one of these points to the next,
///
///     d = (1 - s) d1 + s d2 + e,    var(e) = s (1 - s) accuracy²
///
/// for it need not get there evenly. Of an axis that stands, s = 1/2.
namespace mgtd::calib::effects::laws {

/// At each point of `way`, whose last is the end of the move to a dwell.
[[nodiscard]] std::vector<AngleDeviation> way_deviations(std::span<const PathPoint> way,
                                                         const AngleDeviation& before,
                                                         const AngleDeviation& after);

}  // namespace mgtd::calib::effects::laws
