// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "proto/error.h"
#include "proto/health.h"
#include "proto/reading.h"

/// A LinkStatus tracks the state of a link to a device, from what its port and the device itself report. No
/// port, no clock: what happened comes in, what to show and how long to wait come out.
///
///     ABSENT   no such port                     OPENING  it is there and cannot be opened: why
///     GONE     it was there and went away       PROBING, LIVE, SILENT, FAILED  the device's own words
///     FROZEN   the device goes on sending one and the same reading
///     SATURATED  every reading is at the end of the range
///
/// A port that is not there is looked for every 0.25 s, for as long as it takes: that costs a look into a
/// directory, and a replug is noticed at once. One that is there and cannot be kept open (in use, refused,
/// lost again before its device was live) is tried again after 0.25 s, doubling to 2 s, from the start when
/// its device is live or the port was away. Never a busy loop.
namespace mgtd::drivers {

class LinkStatus {
 public:
  static constexpr double kMissingWait_s = 0.25, kFirstWait_s = 0.25, kLongestWait_s = 2;
  static constexpr double kFrozen_s = 2, kSaturated_s = 1;
  static constexpr int kFrozenReadings = 10;

  void refused(const Error& why);
  void opened();
  void lost(std::string why);
  /// For good.
  void ended();
  /// Each event of the device. Readings only matter.
  void heard(const DeviceEvent& event);
  /// The device is live: the next loss is waited for from the start.
  void live() { wait_s_ = kFirstWait_s; }

  /// Host time until the port is to be tried (again).
  [[nodiscard]] Duration next_wait();
  /// What an operator sees.
  [[nodiscard]] LinkHealth shown(LinkHealth device) const;

 private:
  void judge(const FieldReading& reading);

  bool open_{false}, was_open_{false}, missing_{false};
  LinkState closed_state_{LinkState::absent};
  std::string why_{"not opened yet"};
  double wait_s_{kFirstWait_s};
  std::optional<FieldReading> last_;
  Instant same_since_{}, ranged_since_{};
  int same_{0};
  bool ranged_{false}, frozen_{false}, saturated_{false};
};

}  // namespace mgtd::drivers
