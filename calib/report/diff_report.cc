// SPDX-License-Identifier: Apache-2.0
#include "calib/report/diff_report.h"

#include <fmt/format.h>

#include "calib/report/change_report.h"

namespace mgtd::calib::report {

std::string conclusion_text(const validity::DiffReport& report) {
  const validity::Change& c = report.change;
  const std::string figures = figures_text(c);
  if (!report.changed) return fmt::format("nothing changed that these runs can tell ({})", figures);
  if (!report.remounted.empty()) return "changed: a sensor stands differently";
  if (c.named.empty()) return fmt::format("changed, spread over many parameters ({})", figures);
  return fmt::format("changed: {} ({})", named_text(c), figures);
}

std::vector<std::string> remarks_of(const validity::DiffReport& report) {
  constexpr const char* kAdvice = "the model of both must be the same for its parameters to be compared";
  std::vector<std::string> out;
  for (const std::string& effect : report.only_in_first)
    out.push_back(fmt::format("{} is in the first calibration only: {}", effect, kAdvice));
  for (const std::string& effect : report.only_in_second)
    out.push_back(fmt::format("{} is in the second calibration only: {}", effect, kAdvice));
  for (const std::size_t sensor : report.remounted) {
    out.push_back(
        fmt::format("sensor s{} stands differently: its axes were turned, mirrored or rewired", sensor + 1));
  }
  if (report.scale_taken_out)
    out.emplace_back("a common scale is taken out, because one of them knows no field");
  out.push_back(turn_text(report.turn));
  return out;
}

}  // namespace mgtd::calib::report
