// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "drivers/clock.h"
#include "drivers/device_link.h"

namespace boost::asio {
class io_context;
}

/// A PortLink carries the bytes of one DeviceLink over one serial port; it is the only part of a driver that
/// touches Asio.
///
/// Opens the port (link_status.h: how often, and what is shown), stamps what comes in at the return of the
/// read, writes what the link sends, and ticks it. End of file, EIO, ENXIO and ENODEV all mean the same: the
/// port is gone; it is opened again when it is back, and the device starts over. Times given to the link are
/// those of the Clock, waiting is done in host time.
///
/// All on the thread that runs the io_context. The link outlives this; its callbacks may call send(), and
/// must not destroy this.
namespace mgtd::drivers {

struct PortSettings {
  std::string path;
  int baud{0};  ///< 0: what the device's settings ask for
};

class PortLink {
 public:
  PortLink(boost::asio::io_context& io, const Clock& clock, PortSettings settings, DeviceLink& link);
  /// Ends as shutdown() does.
  ~PortLink();
  PortLink(const PortLink&) = delete;
  PortLink& operator=(const PortLink&) = delete;

  void start();
  /// Nothing happens while the port is closed.
  void send(std::string_view bytes);
  /// The device's last words (a table stops) are sent if the port is there, then the port is closed for good.
  void shutdown();

  /// What is in force against delivery delay; empty while the port is closed.
  [[nodiscard]] std::string latency() const;

 private:
  class Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace mgtd::drivers
