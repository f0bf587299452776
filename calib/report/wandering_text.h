// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/fit/joint/wandering_estimate.h"

namespace mgtd::calib::report {

/// wandering_text() says which offsets wander, and how fast: "slow wandering of all offsets, up to
/// 0.98 +- 0.06 nT per root hour (s2.x)", or "1/f noise of the offsets of s2, up to 21 +- 2 pT/sqrt(Hz) at 1
/// Hz (s2.y)"; empty where none wander.
[[nodiscard]] std::string wandering_text(const fit::joint::WanderingEstimate& wandering);

}  // namespace mgtd::calib::report
