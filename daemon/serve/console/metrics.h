// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "proto/status_report.h"

namespace mgtd::daemon::serve::console {

/// metrics() writes the status in the text format of Prometheus (exposition format 0.0.4); a collector asks
/// for it at /metrics. Names begin with mgtd_, units are in the names, counters end in _total. Nothing that
/// is not known appears. `console_refused`: how often the console refused control or a computation
/// (refusals.h).
[[nodiscard]] std::string metrics(const StatusReport& report, std::uint64_t console_refused);

}  // namespace mgtd::daemon::serve::console
