// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

/// These functions write a probability for a person to read, from its decimal logarithm. Below 1e-30 no test
/// of real data means its figure: that is what is said. Results for programs carry the logarithm itself.
namespace mgtd::calib::stats {

/// Standard deviation of a normal distribution over its median absolute deviation.
inline constexpr double kMadToSd = 1.4826;

/// "0.032", "4e-15", "<1e-30": for a column headed p.
[[nodiscard]] std::string p_text(double log10_p);
/// "p = 0.032", "p < 1e-30": for a sentence.
[[nodiscard]] std::string p_phrase(double log10_p);

}  // namespace mgtd::calib::stats
