// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <set>
#include <string>

#include "proto/check.h"
#include "proto/run_status.h"

/// RunNotices says once what somebody who follows a run has to know while it goes on: which check has failed,
/// why the run waits by itself, and when it goes on.
namespace mgtd::daemon::cli {

/// "  failed: wiring: s2.x points the other way; limit ...; what to do", and the end of the line.
[[nodiscard]] std::string failed_line(const Check& check);
[[nodiscard]] std::string failed_lines(const RunStatus& run);

class RunNotices {
 public:
  /// Empty, or lines.
  std::string of(const RunStatus& run);

 private:
  std::string waiting(const RunStatus& run);
  std::string failed(const RunStatus& run);

  std::string why_;             ///< it waits
  std::set<std::string> said_;  ///< of checks
};

}  // namespace mgtd::daemon::cli
