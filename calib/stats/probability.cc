// SPDX-License-Identifier: Apache-2.0
#include "calib/stats/probability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mgtd::calib::stats {
namespace {

constexpr double kFloor_log10 = -30;

bool is_below(double log10_p) { return log10_p < kFloor_log10; }

std::string figure(double log10_p) {
  if (log10_p > -3) return fmt::format("{:.2g}", std::pow(10.0, std::min(0.0, log10_p)));
  double exponent = std::floor(log10_p);
  double digit = std::round(std::pow(10.0, log10_p - exponent));
  if (digit >= 10) digit = 1, exponent += 1;
  return fmt::format("{:.0f}e{:.0f}", digit, exponent);
}

}  // namespace

std::string p_text(double log10_p) {
  return is_below(log10_p) ? fmt::format("<1e{:.0f}", kFloor_log10) : figure(log10_p);
}

std::string p_phrase(double log10_p) {
  return is_below(log10_p) ? fmt::format("p < 1e{:.0f}", kFloor_log10) : "p = " + figure(log10_p);
}

}  // namespace mgtd::calib::stats
