// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <vector>

#include "calib/design/hypothesis.h"
#include "calib/discovery/discovery_report.h"

namespace mgtd::daemon::run {

/// More of them are not compared: the first hold all but a few percent of the probability.
inline constexpr std::size_t kMostHypotheses = 8;

/// The formulas of a law that discover() leaves open, as hypotheses that a further measurement could tell
/// apart: those that are effects of an array of so many sensors. None where fewer than two are.
[[nodiscard]] std::vector<calib::design::Hypothesis> hypotheses_of(const calib::discovery::FoundLaw& law,
                                                                   int sensors);

}  // namespace mgtd::daemon::run
