// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "daemon/cli/command.h"
#include "drivers/port_list.h"

namespace mgtd::cli {
namespace {

std::string config_line(const drivers::PortInfo& port, std::span<const drivers::PortInfo> all) {
  return fmt::format("port = \"{}\"", drivers::lasting_name(port, all));
}

int run_ports(const Session& session) {
  const auto ports = drivers::list_ports();
  if (session.json) {
    nlohmann::json list = nlohmann::json::array();
    for (const auto& port : ports) {
      list.push_back({{"name", drivers::lasting_name(port, ports)},
                      {"path", port.path},
                      {"description", port.description},
                      {"usb_serial", port.usb_serial},
                      {"usb_id", port.usb_id},
                      {"config", config_line(port, ports)},
                      {"udev", drivers::udev_rule(port, ports, "NAME")}});
    }
    print_json({{"schema", "mgt.ports/1"}, {"ports", list}});
    return 0;
  }
  if (ports.empty()) fmt::print(stderr, "no serial port is plugged in\n");
  for (const auto& port : ports) {
    fmt::print("{:<36} {:<14} {:<10} {}\n", drivers::lasting_name(port, ports), port.path, port.usb_id,
               port.description);
  }
  if (ports.empty()) return 0;
  fmt::print("\n# for mgtd.toml, one of them in each section:\n");
  for (const auto& port : ports) fmt::print("{}\n", config_line(port, ports));
  fmt::print(
      "\n# or fixed names /dev/mgt/NAME, in /etc/udev/rules.d/70-mgtd.rules (s1 .. s4, table, scalar):\n");
  for (const auto& port : ports) {
    const std::string rule = drivers::udev_rule(port, ports, "NAME");
    fmt::print("{}\n", rule.empty()
                           ? fmt::format("# {}: nothing but its number tells it from others", port.path)
                           : rule);
  }
  return 0;
}

}  // namespace

void add_ports(CLI::App& app, Session& session) {
  add_command(app, session, "ports", "the serial ports of this machine, by the names to configure",
              [&session] { return run_ports(session); });
}

}  // namespace mgtd::cli
