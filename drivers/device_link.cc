// SPDX-License-Identifier: Apache-2.0
#include "drivers/device_link.h"

#include <utility>

namespace mgtd::drivers {

LinkHealth DeviceLink::health() const {
  LinkHealth out = status_.shown(device_->health());
  out.state_since = state_since_;
  return out;
}

void DeviceLink::report_state(Stamp now) {
  LinkHealth shown = health();
  if (!state_since_ || shown.state != reported_state_) shown.state_since = state_since_ = now.mono;
  if (shown.state == reported_state_ && shown.detail == reported_detail_) return;
  reported_state_ = shown.state;
  reported_detail_ = shown.detail;
  if (callbacks_.on_state) callbacks_.on_state(shown, now);
}

void DeviceLink::refused(const Error& why, Stamp now) {
  status_.refused(why);
  report_state(now);
}

void DeviceLink::opened(Stamp now) {
  open_ = true;
  status_.opened();
  tell_raw(Direction::opened, std::string_view(), now);
  device_->on_open(now);
  deliver(now);
}

void DeviceLink::received(std::span<const std::byte> bytes, Stamp now) {
  tell_raw(Direction::in, bytes, now);
  device_->on_bytes(bytes, now);
  deliver(now);
}

void DeviceLink::tick(Stamp now) {
  tell_raw(Direction::tick, std::string_view(), now);
  device_->on_tick(now);
  deliver(now);
  if (device_->health().state == LinkState::live) status_.live();
}

void DeviceLink::lost(const std::string& why, Stamp now) {
  open_ = false;
  status_.lost(why);
  tell_raw(Direction::closed, std::string_view(), now);
  device_->on_close(now);
  static_cast<void>(device_->take_output());
  report_state(now);  // first that the device is lost, then what it says about it
  deliver(now);
}

std::string DeviceLink::last_words(Stamp now) {
  tell_raw(Direction::ended, std::string_view(), now);
  device_->on_shutdown(now);
  std::string words = device_->take_output();
  if (!words.empty()) tell_raw(Direction::out, words, now);
  return words;
}

void DeviceLink::closed(Stamp now) {
  open_ = false;
  status_.ended();
  tell_raw(Direction::closed, std::string_view(), now);
  device_->on_close(now);
}

/// False when the device had nothing to send.
bool DeviceLink::send_output(Stamp now) {
  const std::string bytes = device_->take_output();
  if (bytes.empty() || !open_) return false;
  tell_raw(Direction::out, bytes, now);
  if (callbacks_.on_send) callbacks_.on_send(bytes);
  return true;
}

void DeviceLink::deliver(Stamp now) {
  if (std::exchange(delivering_, true)) return;  // a callback asked: the loop below goes on
  for (bool more = true; more;) {
    const bool sent = send_output(now);
    std::vector<DeviceEvent> events = device_->take_events();
    if (!answers(health().state)) report_state(now);
    more = sent || !events.empty();
    for (const DeviceEvent& event : events) status_.heard(event);
    if (!events.empty() && callbacks_.on_events) callbacks_.on_events(std::move(events), now);
  }
  delivering_ = false;
  report_state(now);
}

}  // namespace mgtd::drivers
