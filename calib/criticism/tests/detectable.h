// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/criticism/tests/score.h"

/// A Detectable says how large an effect must be for a run to show it. A coefficient with standard error s,
/// everything else of the model free, is found at d = value / s = 8 in 99 of 100 runs and named right in nine
/// cases of ten, with one chance in a hundred of a false alarm over the whole library.
namespace mgtd::calib::criticism::tests {

inline constexpr double kSeen = 8;
/// Detectable::value where what is in the model takes the effect up whole: beyond all, in any unit.
inline constexpr double kAtNoSize = 1e12;

struct Detectable {
  std::string effect{}, where{};
  double value{0};  ///< smallest coefficient that is seen in 99 of 100 runs like this (d = kSeen)
  std::string unit{};
  [[nodiscard]] double sd() const { return value / kSeen; }
};

/// The worst of the single axes, or of the single coefficients of what has no axes. `value` is 0 where no
/// coefficient leaves a trace.
[[nodiscard]] Detectable detectable_of(const CandidateEffect& candidate_effect, const Signature& signature);

}  // namespace mgtd::calib::criticism::tests
