// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/sample_line.h"

#include <fmt/format.h>

#include <algorithm>

namespace mgtd::daemon::cli {
namespace {

constexpr int kFieldWidth = 10, kGradientWidth = 8;

std::string number(const nlohmann::json& value, int width) {
  return value.is_null() ? fmt::format("{:>{}}", "--", width)
                         : fmt::format("{:{}.2f}", value.get<double>(), width);
}

/// "x 1.00 y 2.00 z 3.00".
std::string components(const nlohmann::json& vector, int width) {
  return fmt::format("x {} y {} z {}", number(vector.at(0), width), number(vector.at(1), width),
                     number(vector.at(2), width));
}

/// Of the standard deviations the largest; empty without a calibration.
std::string sd_text(const nlohmann::json& sd) {
  double largest = 0;
  for (const auto& value : sd)
    if (value.is_number()) largest = std::max(largest, value.get<double>());
  return largest > 0 ? fmt::format(" each to +-{:.2f} or better", largest) : "";
}

std::string gradient_or_field(const nlohmann::json& sample) {
  const auto& g = sample.at("g_nT_per_m");
  const bool told = std::any_of(g.begin(), g.end(), [](const auto& value) { return value.is_number(); });
  if (told) {
    std::string out = "G";
    for (const char* component : {"xx", "yy", "zz", "xy", "xz", "yz"})
      out += fmt::format(" {} {}", component, number(g.at(component), kGradientWidth));
    return out + sd_text(sample.at("g_sd_nT_per_m")) + " nT/m";
  }
  const std::string field = fmt::format("B {} nT", components(sample.at("b_nT"), kFieldWidth));
  if (!sample.contains("along_line_nT_per_m")) return field;
  return fmt::format("{}  G along the line {}{} nT/m", field,
                     components(sample.at("along_line_nT_per_m"), kGradientWidth),
                     sd_text(sample.at("along_line_sd_nT_per_m")));
}

}  // namespace

std::string sample_line(const nlohmann::json& sample) {
  std::string flags;
  for (const auto& flag : sample.at("flags")) flags += " " + flag.get<std::string>();
  const auto& calibration = sample.at("cal");
  return fmt::format("{}  F {} nT  {}  cal {}{}", sample.at("t").get<std::string>().substr(11, 12),
                     number(sample.at("f_nT"), kFieldWidth), gradient_or_field(sample),
                     calibration.is_null() ? "none" : calibration.get<std::string>(), flags);
}

}  // namespace mgtd::daemon::cli
