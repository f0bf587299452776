// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/device.h"
#include "drivers/link_status.h"
#include "proto/health.h"
#include "proto/reading.h"

/// A DeviceLink is one device and the state of its link, without the port: what happens at the port comes in
/// with its time; bytes to send, and what the owner is to know, come out. `port_link` puts it on a serial
/// port, tests put it on a simulated cable, and both see the same behaviour.
///
/// Callbacks may call flush() and methods of the device followed by flush(); they must not destroy the link.
namespace mgtd::drivers {

/// What crossed the port, or was told to the device beside it.
enum class Direction { in, out, opened, closed, tick, ended };

struct LinkCallbacks {
  /// Bytes for the port, which is open.
  std::function<void(std::string_view)> on_send;
  std::function<void(std::vector<DeviceEvent>, Stamp)> on_events;
  /// State or detail changed. That the device no longer answers is told before the events that come with it,
  /// all else after them.
  std::function<void(const LinkHealth&, Stamp)> on_state;
  /// Every byte as it crosses the port, and every opening, closing and tick before the device is told of it
  /// (without bytes), for the journal: whoever tells a device the same again hears the same of it.
  std::function<void(Direction, std::span<const std::byte>, Stamp)> on_raw;
};

class DeviceLink {
 public:
  DeviceLink(std::shared_ptr<Device> device, LinkCallbacks callbacks)
      : device_(std::move(device)), callbacks_(std::move(callbacks)) {}
  DeviceLink(const DeviceLink&) = delete;
  DeviceLink& operator=(const DeviceLink&) = delete;

  /// The port cannot be opened.
  void refused(const Error& why, Stamp now);
  void opened(Stamp now);
  void received(std::span<const std::byte> bytes, Stamp now);
  /// Every 20-50 ms while the port is open.
  void tick(Stamp now);
  /// The port is gone, or was closed because the device wants_reopen().
  void lost(const std::string& why, Stamp now);
  /// The program ends. What is returned is the last that the device wants to send; closed() follows.
  [[nodiscard]] std::string last_words(Stamp now);
  void closed(Stamp now);

  /// Sends what the device wants to send, and tells what it says to that: call after asking it for something.
  void flush(Stamp now) { deliver(now); }

  [[nodiscard]] bool is_open() const { return open_; }
  [[nodiscard]] bool wants_reopen() const { return device_->wants_reopen(); }
  /// Host time until the port is to be tried again.
  [[nodiscard]] Duration next_wait() { return status_.next_wait(); }
  [[nodiscard]] Device& device() { return *device_; }
  [[nodiscard]] const Device& device() const { return *device_; }
  /// The device's own counts and state; while the port is closed, why it is.
  [[nodiscard]] LinkHealth health() const;

 private:
  void deliver(Stamp now);
  bool send_output(Stamp now);
  void report_state(Stamp now);
  void tell_raw(Direction direction, std::span<const std::byte> bytes, Stamp at) const {
    if (callbacks_.on_raw) callbacks_.on_raw(direction, bytes, at);
  }
  void tell_raw(Direction direction, std::string_view bytes, Stamp at) const {
    tell_raw(direction, std::as_bytes(std::span(bytes)), at);
  }

  std::shared_ptr<Device> device_;
  LinkCallbacks callbacks_;
  LinkStatus status_;
  bool open_{false};
  bool delivering_{false};
  LinkState reported_state_{LinkState::absent};
  std::optional<Instant> state_since_;  ///< empty: nothing was reported yet
  std::string reported_detail_;
};

}  // namespace mgtd::drivers
