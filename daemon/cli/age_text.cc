// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/age_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace mgtd::daemon::cli {
namespace {

/// "31.0 degC", "11.9 to 12.3 degC"; empty where no sensor's is known.
std::string temperatures_text(const nlohmann::json& calibration, const char* key) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  const auto found = calibration.find(key);
  if (found == calibration.end() || !found->is_array()) return {};
  for (const auto& T : *found) {
    if (!T.is_number()) continue;
    least = std::min(least, T.get<double>());
    most = std::max(most, T.get<double>());
  }
  if (least > most) return {};
  const std::string from = fmt::format("{:.1f}", least), to = fmt::format("{:.1f}", most);
  return from == to ? from + " degC" : fmt::format("{} to {} degC", from, to);
}

}  // namespace

std::string age_text(double seconds) {
  constexpr double kMinute_s = 60, kHour_s = 3600, kDay_s = 86'400;
  const auto whole = [&](double unit_s) { return std::floor(std::max(0.0, seconds) / unit_s); };
  if (seconds < 2 * kMinute_s) return fmt::format("{:.0f} s", whole(1));
  if (seconds < 2 * kHour_s) return fmt::format("{:.0f} min", whole(kMinute_s));
  if (seconds < 2 * kDay_s) return fmt::format("{:.0f} h", whole(kHour_s));
  return fmt::format("{:.0f} days", whole(kDay_s));
}

std::string conditions_text(const nlohmann::json& calibration) {
  const auto age = calibration.find("age_s");
  const bool aged = age != calibration.end() && age->is_number();
  const std::string made = temperatures_text(calibration, "made_at_degC"),
                    now = temperatures_text(calibration, "now_degC");
  if (!aged && made.empty()) return {};
  std::string out = "made";
  if (aged) out += fmt::format(" {} ago", age_text(age->get<double>()));
  if (made.empty()) return out;
  out += " at " + made;
  return now.empty() ? out : out + ", now " + now;
}

}  // namespace mgtd::daemon::cli
