// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "proto/time.h"

/// EpochRate tells how many epochs come per second of the rig's time, measured over about a second of the
/// host's. Pure.
namespace mgtd::daemon::app {

class EpochRate {
 public:
  /// `speed_up`: seconds of the rig in one of the host.
  explicit EpochRate(double speed_up) : speed_up_(speed_up) {}

  /// A second has passed since add(), or there was none.
  [[nodiscard]] bool is_due(Instant host) const {
    return !since_ || host - *since_ >= std::chrono::seconds(1);
  }
  /// `epochs`: all so far.
  void add(std::uint64_t epochs, Instant host) {
    if (since_) rate_hz_ = static_cast<double>(epochs - epochs_) / to_seconds(host - *since_) / speed_up_;
    since_ = host;
    epochs_ = epochs;
  }
  /// Empty until it is known.
  [[nodiscard]] std::optional<double> rate_hz() const { return rate_hz_; }

 private:
  double speed_up_;
  std::optional<Instant> since_;
  std::uint64_t epochs_{0};
  std::optional<double> rate_hz_;
};

}  // namespace mgtd::daemon::app
