// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/ports.h"

namespace mgtd::daemon::app {

Ports::Ports(boost::asio::io_context& io, const drivers::Clock& clock, const config::Config& config,
             acquire::Instruments& instruments) {
  for (const auto& [slot, device] : acquire::devices_of(config)) {
    if (!instruments.has_port(slot)) continue;
    ports_.emplace(slot,
                   std::make_unique<drivers::PortLink>(
                       io, clock, drivers::PortSettings{device->port, device->baud}, instruments.link(slot)));
  }
}

void Ports::start() {
  for (auto& [slot, port] : ports_) port->start();
}

void Ports::shutdown() {
  if (const auto table = ports_.find(Slot::table()); table != ports_.end()) table->second->shutdown();
  for (auto& [slot, port] : ports_) port->shutdown();
}

}  // namespace mgtd::daemon::app
