// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/formula/history_name.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proto/number.h"

namespace mgtd::calib::effects::formula {
namespace {

constexpr double kNoHistory = std::numeric_limits<double>::quiet_NaN();

std::vector<double> previous(std::span<const double> of) {
  std::vector<double> out(of.size(), kNoHistory);
  for (std::size_t k = 1; k < of.size(); ++k) out[k] = of[k - 1];
  return out;
}

/// Exact for an input that goes straight from pose to pose.
std::vector<double> low_pass(std::span<const double> t_h, std::span<const double> of, double tau_h) {
  std::vector<double> out(of.size(), kNoHistory);
  for (std::size_t k = 0; k < of.size(); ++k) {
    if (k == 0 || std::isnan(out[k - 1]) || std::isnan(of[k - 1])) {
      out[k] = of[k];
      continue;
    }
    const double dt = t_h[k] - t_h[k - 1];
    if (!(dt > 0)) {
      out[k] = out[k - 1];
      continue;
    }
    const double slope = (of[k] - of[k - 1]) / dt;
    out[k] = of[k] - slope * tau_h + (out[k - 1] - of[k - 1] + slope * tau_h) * std::exp(-dt / tau_h);
  }
  return out;
}

std::vector<double> slope_around(std::span<const double> t_h, std::span<const double> of) {
  constexpr std::size_t kBeside = 4;
  std::vector<double> out(of.size(), kNoHistory);
  for (std::size_t k = 0; k < of.size(); ++k) {
    const std::size_t first = k < kBeside ? 0 : k - kBeside, last = std::min(of.size(), k + kBeside + 1);
    const auto n = static_cast<double>(last - first);
    double t = 0, x = 0, tt = 0, tx = 0;
    for (std::size_t i = first; i < last; ++i) t += t_h[i] / n, x += of[i] / n;
    for (std::size_t i = first; i < last; ++i)
      tt += (t_h[i] - t) * (t_h[i] - t), tx += (t_h[i] - t) * (of[i] - x);
    if (tt > 0) out[k] = tx / tt;
  }
  return out;
}

/// A name that no column of the user's has by chance.
bool of_a_sensor(std::string_view name) {
  if (name == "T_degC") return true;
  const auto end = name.find('_');
  if (!name.starts_with('s') || end == std::string_view::npos || end < 2) return false;
  const std::string_view digits = name.substr(1, end - 1), quantity = name.substr(end + 1);
  return digits.find_first_not_of("0123456789") == std::string_view::npos &&
         (quantity == "T_degC" || quantity == "x_nT" || quantity == "y_nT" || quantity == "z_nT");
}

bool of_the_field(std::string_view name) {
  return name == "u" || name == "ux" || name == "uy" || name == "uz";
}

}  // namespace

std::optional<HistoryName> history_name(std::string_view name) {
  constexpr std::string_view kPrevious = "prev_", kRate = "rate_", kLag = "lag";
  if (name.starts_with(kPrevious)) {
    const std::string_view of = name.substr(kPrevious.size());
    if (!of_a_sensor(of) && !of_the_field(of)) return std::nullopt;
    return HistoryName{.kind = HistoryName::Kind::previous, .of = std::string(of)};
  }
  if (name.starts_with(kRate)) {
    const std::string_view of = name.substr(kRate.size());
    if (!of_a_sensor(of)) return std::nullopt;
    return HistoryName{.kind = HistoryName::Kind::rate, .of = std::string(of)};
  }
  const auto end = name.find('_');
  if (!name.starts_with(kLag) || end == std::string_view::npos) return std::nullopt;
  const auto tau_s = parse_number(name.substr(kLag.size(), end - kLag.size()));
  if (!tau_s || !(*tau_s > 0)) return std::nullopt;
  return HistoryName{
      .kind = HistoryName::Kind::lag, .tau_s = *tau_s, .of = std::string(name.substr(end + 1))};
}

std::vector<double> history(const HistoryName& name, std::span<const double> t_h,
                            std::span<const double> of) {
  constexpr double kSecondsPerHour = 3600;
  switch (name.kind) {
    case HistoryName::Kind::previous:
      return previous(of);
    case HistoryName::Kind::lag:
      return low_pass(t_h, of, name.tau_s / kSecondsPerHour);
    case HistoryName::Kind::rate:
      return slope_around(t_h, of);
  }
  return {};
}

}  // namespace mgtd::calib::effects::formula
