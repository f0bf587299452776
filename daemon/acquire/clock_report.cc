// SPDX-License-Identifier: Apache-2.0
#include "daemon/acquire/clock_report.h"

#include <fmt/format.h>

#include <cmath>

namespace mgtd::daemon::acquire {

ClockStatus clock_report(const ClockState& clock, double rate_hz) {
  ClockStatus out{clock.rate_error, clock.rate_error_pm, clock.bound_s, clock.step_s, clock.settled, {}};
  if (!clock.settled || std::abs(clock.rate_error) - clock.rate_error_pm <= kMostRateError) return out;
  out.trouble = fmt::format(
      "its rate is {:.2f} % too {}: {:.3f} readings a second instead of {:g}, known to {:.2g} % (limit {:g} "
      "%); "
      "each sample is placed where this clock took it; check the digitiser's oscillator and its trigger "
      "period, "
      "or exchange it",
      100 * std::abs(clock.rate_error), clock.rate_error < 0 ? "low" : "high",
      rate_hz * (1 + clock.rate_error), rate_hz, 100 * clock.rate_error_pm, 100 * kMostRateError);
  return out;
}

}  // namespace mgtd::daemon::acquire
