// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <boost/asio/io_context.hpp>
#include <map>
#include <memory>
#include <string_view>

#include "daemon/acquire/instruments.h"
#include "drivers/clock.h"
#include "drivers/port_link.h"

/// Ports holds the serial ports of all instruments that have one.
namespace mgtd::daemon::app {

class Ports {
 public:
  /// All outlive this.
  Ports(boost::asio::io_context& io, const drivers::Clock& clock, const config::Config& config,
        acquire::Instruments& instruments);

  void start();
  void send(Slot slot, std::string_view bytes) { ports_.at(slot)->send(bytes); }
  /// The table is told to stop, then every port is closed.
  void shutdown();

 private:
  std::map<Slot, std::unique_ptr<drivers::PortLink>> ports_;
};

}  // namespace mgtd::daemon::app
