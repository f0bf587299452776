// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "daemon/cli/command.h"
#include "drivers/port_list.h"

namespace mgtd::cli {
namespace {

int run_ports(const Session& session) {
  const auto ports = drivers::list_ports();
  if (session.json) {
    nlohmann::json list = nlohmann::json::array();
    for (const auto& port : ports) {
      list.push_back({{"name", drivers::lasting_name(port, ports)},
                      {"path", port.path},
                      {"description", port.description},
                      {"usb_serial", port.usb_serial},
                      {"usb_id", port.usb_id}});
    }
    print_json({{"schema", "mgt.ports/1"}, {"ports", list}});
    return 0;
  }
  if (ports.empty()) fmt::print(stderr, "no serial port is plugged in\n");
  for (const auto& port : ports) {
    fmt::print("{:<36} {:<14} {:<10} {}\n", drivers::lasting_name(port, ports), port.path, port.usb_id,
               port.description);
  }
  return 0;
}

}  // namespace

void add_ports(CLI::App& app, Session& session) {
  add_command(app, session, "ports", "the serial ports of this machine, by the names to configure",
              [&session] { return run_ports(session); });
}

}  // namespace mgtd::cli
