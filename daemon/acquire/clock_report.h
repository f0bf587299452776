// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "daemon/acquire/clock_model.h"
#include "proto/status_report.h"

/// clock_report() says how a digitiser's clock is doing, for the operator. A rate that is off by more than
/// any oscillator (kMostRateError, beyond what the estimate leaves open) is trouble: something is wrong with
/// the trigger or the oscillator. Its samples keep their true times all the same. Pure.
namespace mgtd::daemon::acquire {

inline constexpr double kMostRateError = 5e-4;

[[nodiscard]] ClockStatus clock_report(const ClockState& clock, double rate_hz);

}  // namespace mgtd::daemon::acquire
