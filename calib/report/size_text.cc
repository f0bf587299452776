// SPDX-License-Identifier: Apache-2.0
#include "calib/report/size_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mgtd::calib::report {
namespace {

/// As many decimals as show two digits of the standard deviation, without an exponent where that stays short.
std::string signed_with_sd(double value, double sd) {
  constexpr double kShort = 1e-4;
  if (!(sd > kShort)) return fmt::format("{:+.3g} +- {:.1g}", value, sd);
  const int decimals = std::max(0, 1 - static_cast<int>(std::floor(std::log10(sd))));
  return fmt::format("{:+.{}f} +- {:.{}f}", value, decimals, sd, decimals);
}

}  // namespace

std::string size_text(const criticism::tests::Candidate& c) {
  const calibration::EffectCoefficient* const largest = criticism::tests::seen_most(c);
  if (largest == nullptr) return "";
  const std::string what = c.coefficients.size() > 1 ? largest->name + " " : "";
  return fmt::format("{}{} {}", what, signed_with_sd(largest->value, largest->sd), largest->unit);
}

}  // namespace mgtd::calib::report
