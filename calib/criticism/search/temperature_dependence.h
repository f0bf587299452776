// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "calib/criticism/search/explain_report.h"

/// A dependence on temperature is one law with a linear and a square term: axis.gain.temperature and
/// axis.gain.temperature2 are effects of the library of their own, and stand for one curve.
namespace mgtd::calib::criticism::search {

/// "axis.gain.temperature" of both terms; nothing of an effect that is no term of such a dependence.
[[nodiscard]] std::optional<std::string> temperature_dependence(std::string effect);

/// Whether one of these rounds, with a size of at least `sigmas` standard deviations, added a term of the
/// dependence that `effect` is a term of. False where it is none.
[[nodiscard]] bool added_term_of_dependence(const std::vector<Round>& rounds, const std::string& effect,
                                            double sigmas = 0);

}  // namespace mgtd::calib::criticism::search
