// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "daemon/cli/ask.h"
#include "daemon/cli/serial_lines.h"
#include "daemon/config/config.h"
#include "daemon/store/durable_file.h"
#include "drivers/port_list.h"

namespace mgtd::daemon::cli {
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
    fmt::print("{}\n",
               rule.empty() ? fmt::format("# {}: only its number tells it from others", port.path) : rule);
  }
  return 0;
}

/// The serial numbers that the live instruments of a running daemon reported, by device name.
std::map<std::string, std::string> serials_of(const nlohmann::json& status) {
  std::map<std::string, std::string> out;
  for (const auto& device : status.at("devices")) {
    if (device.at("state") != "live") continue;
    const std::string serial = stated_serial(device.at("driver").get<std::string>(), device.at("identity"));
    if (!serial.empty()) out[device.at("name")] = serial;
  }
  return out;
}

/// Fills in the serial numbers of the instruments that answer now.
int write_serials(const Session& session, const std::string& file) {
  const auto text = read_file(file);
  if (!text) return print_error(session, text.error());
  const auto status = ask(session, ControlCommand::status);
  if (!status) return print_error(session, status.error());
  const SerialLines done = with_serials(*text, serials_of(*status));
  if (!done.written.empty()) {
    if (const auto good = config::parse_config(done.text, file); !good) {
      for (const std::string& line : good.error().lines) fmt::print(stderr, "{}\n", line);
      fmt::print(stderr, "{} is left as it was\n", file);
      return 2;
    }
    if (auto written = store::write_durably(file, done.text); !written)
      return print_error(session, written.error());
  }
  if (session.json) {
    print_json({{"schema", "mgt.ports/1"}, {"written", done.written}, {"stated", done.stated}});
  } else if (done.written.empty()) {
    fmt::print("no serial number to fill in; {} stated already\n", done.stated.size());
  } else {
    fmt::print("{}: serial of {} filled in; it takes effect when mgtd is restarted\n", file,
               fmt::join(done.written, ", "));
  }
  return 0;
}

}  // namespace

void add_ports(CLI::App& app, Session& session) {
  const auto file = std::make_shared<std::string>();
  CLI::App* const command = add_command(
      app, session, "ports", "the serial ports of this machine, by the names to use in the configuration",
      [file, &session] { return file->empty() ? run_ports(session) : write_serials(session, *file); });
  command->add_option(
      "--write", *file,
      "fill the serial numbers of the instruments that answer the daemon into this configuration");
}

}  // namespace mgtd::daemon::cli
