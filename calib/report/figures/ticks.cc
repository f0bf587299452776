// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mgtd::calib::report::figures {
namespace {

constexpr const char* kMinus = "\u2212";

/// The handiest step: 1, 2 or 5 times a power of ten.
double handy_step(double span, int about) {
  const double rough = span / std::max(1, about), power = std::pow(10, std::floor(std::log10(rough)));
  const double share = rough / power;
  return (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10) * power;
}

std::vector<double> multiples(const Range& range, double step) {
  std::vector<double> out;
  const double slack = 1e-9 * (range.to - range.from);
  for (double i = std::ceil((range.from - slack) / step); i * step <= range.to + slack; ++i)
    out.push_back(i == 0 ? 0 : i * step);
  return out;
}

/// Numbers beyond these take a common power of ten.
int common_power(const Range& range) {
  const double most = std::max(std::abs(range.from), std::abs(range.to));
  if (!(most > 0)) return 0;
  const int power = static_cast<int>(std::floor(std::log10(most)));
  return power >= 6 || power < -3 ? power : 0;
}

Ticks linear_ticks(const Range& range, double step) {
  Ticks out{.ticks = {}, .power = common_power(range)};
  const double unit = std::pow(10, out.power);
  const int decimals = std::clamp(-static_cast<int>(std::floor(std::log10(step / unit) + 1e-9)), 0, 9);
  for (const double v : multiples(range, step)) out.ticks.push_back({v, number_label(v / unit, decimals)});
  return out;
}

Ticks log_ticks(const Range& range, int about) {
  Ticks out;
  const double decades = std::log10(range.to / range.from);
  const int every = std::max(1, static_cast<int>(std::ceil(decades / std::max(1, about))));
  const bool between = decades < 2.2;
  const int first = static_cast<int>(std::floor(std::log10(range.from))),
            last = static_cast<int>(std::ceil(std::log10(range.to)));
  const bool plain = first >= -4 && last <= 6;
  const Scale inside(range, 0, 1, ScaleKind::log);
  for (int p = first; p <= last; ++p) {
    for (int digit = 1; digit <= 9; ++digit) {
      const double value = digit * std::pow(10, p);
      if (!inside.holds(value)) continue;
      const bool named = digit == 1 ? p % every == 0 : between && (digit == 2 || digit == 5);
      if (!named && every > 1) continue;
      std::string label;
      if (named && plain) label = number_label(value, std::max(0, -p));
      if (named && !plain) label = (digit == 1 ? "" : fmt::format("{}", digit)) + power_label(p);
      if (digit == 1 && !label.empty() && !plain) label = label.substr(label.find("10"));
      out.ticks.push_back({value, label});
    }
  }
  return out;
}

}  // namespace

std::string number_label(double value, int decimals) {
  std::string digits = fmt::format("{:.{}f}", std::abs(value), decimals);
  const bool zero = digits.find_first_not_of("0.") == std::string::npos;
  return value < 0 && !zero ? kMinus + digits : digits;
}

std::string power_label(int power) {
  static const char* const kRaised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = power < 0 ? "×10⁻" : "×10";
  for (const char c : fmt::format("{}", std::abs(power))) out += kRaised[c - '0'];
  return out;
}

std::string short_number(double value) {
  if (std::isnan(value)) return "unknown";
  if (std::isinf(value)) return value > 0 ? "∞" : "\u2212∞";
  if (value == 0) return "0";
  const double size = std::abs(value);
  std::string out;
  if (size >= 1e6 || size < 1e-4) {
    out = fmt::format("{:.2g}", size);
  } else {
    const int power = static_cast<int>(std::floor(std::log10(size)));
    out = fmt::format("{:.{}f}", size, std::clamp(2 - power, 0, 6));
  }
  return value < 0 ? kMinus + out : out;
}

Ticks ticks_of(const Range& range, ScaleKind kind, int about) {
  const Range r = Scale(range, 0, 1, kind).range();
  constexpr double kNearlyLinear = 5;  // where 1, 2 and 5 would be too few
  if (kind == ScaleKind::log && r.to > kNearlyLinear * r.from) return log_ticks(r, about);
  Ticks out = linear_ticks(r, handy_step(r.to - r.from, about));
  for (int more = 2; out.ticks.size() < 2 && more <= 8; more *= 2)
    out = linear_ticks(r, handy_step(r.to - r.from, more * about));
  return out;
}

Ticks angle_ticks_of(const Range& range_deg, int about) {
  const Range r = Scale(range_deg, 0, 1).range();
  for (const double step : {15.0, 30.0, 45.0, 90.0, 180.0})
    if ((r.to - r.from) / step <= about && (r.to - r.from) / step >= 1.9) return linear_ticks(r, step);
  return ticks_of(r, ScaleKind::linear, about);
}

}  // namespace mgtd::calib::report::figures
