// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/discovery/chosen_law.h"
#include "calib/discovery/noise_in_force.h"

/// The verdict on a run, from the laws that were found in it and from what is left after them.
namespace mgtd::calib::discovery {

/// Chance of a formula where nothing is there, of the whole search.
inline constexpr double kFalseDiscovery = 0.01;

/// `report`: with what is left after the laws.
[[nodiscard]] Verdict verdict_of(const NoiseInForce& in_force, const std::vector<ChosenLaw>& laws,
                                 const DiscoveryReport& report);

}  // namespace mgtd::calib::discovery
