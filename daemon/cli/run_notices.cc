// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/run_notices.h"

#include <fmt/format.h>

namespace mgtd::daemon::cli {

std::string failed_line(const Check& check) {
  return fmt::format("  failed: {}: {}; limit {}; {}\n", check.name, check.measured, check.limit,
                     check.remedy);
}

std::string failed_lines(const RunStatus& run) {
  std::string out;
  for (const Check& check : run.checks)
    if (!check.passed) out += failed_line(check);
  return out;
}

std::string RunNotices::of(const RunStatus& run) { return waiting(run) + failed(run); }

std::string RunNotices::waiting(const RunStatus& run) {
  const std::string why = run.state == RunState::paused && run.goes_on ? run.message : std::string();
  if (why == why_) return {};
  why_ = why;
  if (!why.empty()) return why + "\n";
  const bool measures =
      is_active(run.state) && run.state != RunState::paused && run.state != RunState::aborting;
  return measures ? "the run goes on\n" : "";
}

/// Where the run ends or waits for the operator, all of them are shown anyway.
std::string RunNotices::failed(const RunStatus& run) {
  if (!is_active(run.state) || run.state == RunState::paused) return {};
  std::string out;
  for (const Check& check : run.checks) {
    if (check.passed) continue;
    if (std::string line = failed_line(check); said_.insert(line).second) out += line;
  }
  return out;
}

}  // namespace mgtd::daemon::cli
