// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/clock.h"
#include "drivers/device.h"
#include "proto/health.h"
#include "proto/reading.h"

namespace boost::asio {
class io_context;
}

/// A PortLink carries the bytes of one Device over one serial port; it is the only part of a driver that
/// touches Asio.
///
/// Opens the port (link_life.h: how often, and what is shown), stamps what comes in at the return of the
/// read, sends what the device leaves, ticks it, and tells the owner what happened. End of file, EIO, ENXIO
/// and ENODEV all mean the same: the port is gone; it is opened again when it is back, and the device starts
/// over. Times given to the device are those of the Clock, waiting is done in host time.
///
/// All on the thread that runs the io_context. Callbacks may call flush(), and methods of the device followed
/// by flush(); they must not destroy the link.
namespace mgtd::drivers {

/// What crossed the port, or was told to the device beside it.
enum class Direction { in, out, opened, closed, tick, ended };

struct PortSettings {
  std::string path;
  int baud{0};  ///< 0: what the device's settings ask for
};

struct PortCallbacks {
  std::function<void(std::vector<DeviceEvent>)> on_events;
  /// Every byte as it crossed the port, and every opening, closing and tick before the device is told of it
  /// (without bytes), for the journal: whoever tells a device the same again hears the same of it.
  std::function<void(Direction, std::span<const std::byte>, Stamp)> on_raw;
  /// State or detail changed. That the device no longer answers is told before the events that come with it,
  /// all else after them.
  std::function<void(const LinkHealth&)> on_state;
};

class PortLink {
 public:
  PortLink(boost::asio::io_context& io, const Clock& clock, PortSettings settings,
           std::shared_ptr<Device> device, PortCallbacks callbacks);
  /// Ends as shutdown() does.
  ~PortLink();
  PortLink(const PortLink&) = delete;
  PortLink& operator=(const PortLink&) = delete;

  void start();
  /// Sends what the device wants to send: call after asking it for something. What it has to say about that
  /// is told from the event loop, never before flush() returns.
  void flush();
  /// The device's last words (a table stops) are sent if the port is there, then the port is closed for good.
  void shutdown();

  [[nodiscard]] Device& device();
  /// The device's own books; while the port is closed, why it is.
  [[nodiscard]] LinkHealth health() const;
  /// What is in force against delivery delay; empty while the port is closed.
  [[nodiscard]] std::string latency() const;

 private:
  class Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace mgtd::drivers
