// SPDX-License-Identifier: Apache-2.0
#include "drivers/link_status.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

namespace mgtd::drivers {

void LinkStatus::refused(const Error& why) {
  open_ = false;
  why_ = why.text();
  missing_ = why.code == ErrorCode::unreachable;
  closed_state_ = !missing_ ? LinkState::opening : was_open_ ? LinkState::gone : LinkState::absent;
}

void LinkStatus::opened() {
  open_ = was_open_ = true;
  missing_ = false;
  last_.reset();
  same_ = 0;
  ranged_ = frozen_ = saturated_ = false;
}

void LinkStatus::lost(std::string why) {
  open_ = false;
  closed_state_ = LinkState::gone;
  why_ = std::move(why);
}

void LinkStatus::ended() {
  open_ = was_open_ = false;
  closed_state_ = LinkState::absent;
  why_ = "closed";
}

void LinkStatus::heard(const DeviceEvent& event) {
  if (const auto* const reading = std::get_if<FieldReading>(&event)) judge(*reading);
}

void LinkStatus::judge(const FieldReading& reading) {
  const Instant now = reading.arrival.mono;
  if (!last_ || last_->y_nT != reading.y_nT) {
    same_since_ = now;
    same_ = 0;
  }
  ++same_;
  if (!ranged_) ranged_since_ = now;
  ranged_ = reading.flags.has(Flag::saturated);
  // At the end of the range all readings are alike: that is no frozen device.
  saturated_ = ranged_ && now - ranged_since_ >= from_seconds(kSaturated_s);
  frozen_ = !ranged_ && same_ > kFrozenReadings && now - same_since_ >= from_seconds(kFrozen_s);
  last_ = reading;
}

Duration LinkStatus::next_wait() {
  if (missing_) {
    wait_s_ = kFirstWait_s;  // what is plugged in next has not failed yet
    return from_seconds(kMissingWait_s);
  }
  return from_seconds(std::exchange(wait_s_, std::min(2 * wait_s_, kLongestWait_s)));
}

LinkHealth LinkStatus::shown(LinkHealth device) const {
  if (!open_) {
    device.state = closed_state_;
    device.detail = why_;
  } else if (device.state == LinkState::live && frozen_) {
    device.state = LinkState::frozen;
    device.detail = fmt::format(
        "{} readings in a row are the same to the last digit; switch the instrument off and on, and look at "
        "the "
        "cable to the sensor",
        same_);
  } else if (device.state == LinkState::live && saturated_) {
    device.state = LinkState::saturated;
    device.detail =
        "every reading is at the end of the range; take iron and magnets away, look at the range that is "
        "configured, and whether the sensor is powered";
  }
  return device;
}

}  // namespace mgtd::drivers
