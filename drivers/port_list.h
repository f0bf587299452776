// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// The port list names the serial ports of this machine. A number like ttyUSB0 changes with the order of
/// plugging in; the serial number of the USB converter does not: "usb:SERIAL" names a port by it wherever a
/// path is expected.
namespace mgtd::drivers {

struct PortInfo {
  std::string path;             ///< /dev/ttyUSB0
  std::string description;      ///< as the converter calls itself
  std::string usb_serial;       ///< empty for ports that are not on USB
  std::string usb_id;           ///< "0403:6001"
  std::string usb_interface{};  ///< of a converter with several ports: "00"; else empty
  std::string by_path;  ///< udev's name for the socket it is in (/dev/serial/by-path/...); may be empty
  [[nodiscard]] std::string name() const { return usb_serial.empty() ? path : "usb:" + usb_serial; }
};

[[nodiscard]] std::vector<PortInfo> list_ports();

/// What to write into the configuration: the serial number where it is there and no other port has it (the
/// ports of a four-port converter share one), else the socket, else the path.
[[nodiscard]] std::string lasting_name(const PortInfo& port, std::span<const PortInfo> all);

/// The rule of udev that gives a port the name /dev/mgt/NAME, wherever it is numbered (70-mgtd.rules). Empty
/// for a port that nothing but its number tells from others.
[[nodiscard]] std::string udev_rule(const PortInfo& port, std::span<const PortInfo> all,
                                    std::string_view name);

/// The port of the USB converter with this serial number, the first of several. Looks into sysfs only: no
/// port is opened, so that it may be asked often while one is missing and no other device notices.
[[nodiscard]] std::optional<std::string> port_of_usb_serial(const std::string& serial,
                                                            const std::string& sysfs = "/sys");

/// The path behind a name: "usb:SERIAL" is looked up, links are followed. Empty when no such converter is
/// plugged in.
[[nodiscard]] std::optional<std::string> port_path(const std::string& name);

}  // namespace mgtd::drivers
