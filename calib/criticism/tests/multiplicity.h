// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "calib/criticism/tests/score.h"

/// calibrate() corrects the smallest p-value of a family for the number of questions that were asked. When
/// nothing is there, the smallest of many p-values is small by chance, and the questions are not independent.
/// Under the model the sums z'r of all effects are jointly normal with covariance z'z, so draws of them give
/// the smallest p of every family, and the smallest of all families, without any refit.
///
/// If m independent questions were asked, -ln(1 - p_min) would be exponential with rate m. That rate is
/// estimated from the draws' lower third (maximum likelihood with the rest censored), which fixes the 1 %
/// point far better than counting draws below it, and p becomes 1 - (1 - p)^m.
namespace mgtd::calib::criticism::tests {

/// Rates by the name of a family, and that of the best of all.
struct Rates {
  std::map<std::string, double> family{};
  double best{1};
};

/// By a thousand draws.
[[nodiscard]] Rates draw_rates(const std::vector<ScoredFamily>& families, std::uint64_t seed);

/// Sets `asked` and `calibrated` of each family. False where a family has no rate.
bool calibrate(std::vector<ScoredFamily>& families, const Rates& rates);

/// The m of a smallest p-value, from draws of it (log10 p), as above.
[[nodiscard]] double questions_asked(std::vector<double> log10_p);

/// 1 - (1 - p)^m of logarithms.
[[nodiscard]] double best_of(double log10_p, double m);

}  // namespace mgtd::calib::criticism::tests
