// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/effects/effect.h"

namespace mgtd::calib::effects {

/// check_derivatives() compares an effect's derivatives by the field (or the place) and by its coefficients
/// with differences of its value over a wide step, at every pose and sensor, with readings in place of the
/// field. Refuses, with pose, sensor and both numbers, where they differ by more than a twentieth of the
/// largest derivative of that input: the derivative is wrong, or the law jumps or kinks, which a fit cannot
/// follow.
[[nodiscard]] Result<void> check_derivatives(const Effect& effect, const PoseTable& table);

}  // namespace mgtd::calib::effects
