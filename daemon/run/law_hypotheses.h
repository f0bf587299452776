// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <vector>

#include "calib/design/hypothesis.h"
#include "calib/discovery/discovery_report.h"
#include "calib/fit/fit_options.h"

namespace mgtd::daemon::run {

/// No more hypotheses than kMostHypotheses are compared: the first hold all but a few percent of the
/// probability.
inline constexpr std::size_t kMostHypotheses = 8;

/// hypotheses_of() gives the formulas of a law that discover() leaves open, as hypotheses that a further
/// measurement could tell apart: those that are effects of an array of so many sensors. None where fewer than
/// two are.
[[nodiscard]] std::vector<calib::design::Hypothesis> hypotheses_of(const calib::discovery::FoundLaw& law,
                                                                   int sensors);

/// Puts the leading formulas of the other laws into the model that those hypotheses are compared in, but for
/// laws weaker than the one that is asked about: those stand in the residual as noise does.
void add_laws_beside(const calib::discovery::DiscoveryReport& found, std::size_t asked, int sensors,
                     calib::fit::FitOptions& options);

}  // namespace mgtd::daemon::run
