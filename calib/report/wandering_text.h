// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/fit/joint/wandering_estimate.h"

namespace mgtd::calib {

/// "slow wandering of all offsets, up to 0.98 +- 0.06 nT per root hour (s2.x)"; empty where none wander.
[[nodiscard]] std::string wandering_text(const WanderingEstimate& wandering);

}  // namespace mgtd::calib
