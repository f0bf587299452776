// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/fit/joint/wandering_estimate.h"

namespace mgtd::calib::report {

/// "slow wandering of all offsets, up to 0.98 +- 0.06 nT per root hour (s2.x)"; empty where none wander.
[[nodiscard]] std::string wandering_text(const fit::joint::WanderingEstimate& wandering);

}  // namespace mgtd::calib::report
