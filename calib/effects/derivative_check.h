// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/effects/effect.h"

namespace mgtd::calib {

/// An effect's derivatives by the field (or the place) and by its coefficients against differences of its
/// value over a wide step, at every pose and sensor, readings standing for the field. Refuses with pose,
/// sensor, and both numbers where they differ by more than a twentieth of the largest derivative of that
/// input: a derivative that is wrong, or a law that jumps or kinks, which a fit cannot follow.
[[nodiscard]] Result<void> check_derivatives(const Effect& effect, const PoseTable& table);

}  // namespace mgtd::calib
