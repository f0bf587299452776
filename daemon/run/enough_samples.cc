// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/enough_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mgtd::daemon::run {

Result<void> enough_samples(const plan::RunPlan& plan, const RunConfig& config) {
  const double rate_hz = config.dwell.rate_hz;
  const auto shortest = std::min_element(
      plan.poses.begin(), plan.poses.end(),
      [](const plan::PlannedPose& a, const plan::PlannedPose& b) { return a.dwell_s < b.dwell_s; });
  if (shortest == plan.poses.end()) return {};
  const double samples = std::floor(shortest->dwell_s * rate_hz + 1e-9);
  if (samples < static_cast<double>(kFewestInDwell)) {
    return fail(ErrorCode::refused,
                fmt::format("the dwell of pose {}, {:g} s, holds {:.0f} samples at {:g} Hz, at least {} are "
                            "needed",
                            shortest->number, shortest->dwell_s, samples, rate_hz, kFewestInDwell),
                fmt::format("make every dwell {:g} s or longer (--dwell-short, dwell_s), or raise rate_hz",
                            static_cast<double>(kFewestInDwell) / rate_hz));
  }
  const double window_s = whole_window_s(config.settle);
  const bool by_rate = window_s > config.settle.window_s;
  if (by_rate && window_s >= config.settle.max_s) {
    return fail(
        ErrorCode::refused,
        fmt::format("at {:g} Hz it takes {:.3g} s to see that the field is steady ({} samples), limit "
                    "settle_max_s = {:g} s",
                    rate_hz, window_s, kFewestInWindow, config.settle.max_s),
        fmt::format("raise settle_max_s well above {:.3g} s, or rate_hz", window_s));
  }
  return {};
}

}  // namespace mgtd::daemon::run
