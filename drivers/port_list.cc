// SPDX-License-Identifier: Apache-2.0
#include "drivers/port_list.h"

#include <fmt/format.h>
#include <libserialport.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <system_error>

namespace mgtd::drivers {
namespace {

std::string text(const char* text_or_null) { return text_or_null == nullptr ? std::string() : text_or_null; }

/// Of a USB port, as sysfs has it: "00"; empty where there is none.
std::string interface_of(const std::string& path) {
  const std::string device = "/sys/class/tty/" + path.substr(path.find_last_of('/') + 1) + "/device";
  for (const char* const up : {"/../bInterfaceNumber", "/bInterfaceNumber"}) {
    std::ifstream in(device + up);
    if (std::string number; in >> number) return number;
  }
  return {};
}

/// Of the USB device that a port is part of; nothing where it is of none. A port hangs below one of the
/// interfaces of its device.
std::optional<std::string> usb_serial_of(const std::filesystem::path& device) {
  constexpr int kLevels = 4;
  std::error_code none;
  auto at = std::filesystem::canonical(device, none);
  for (int level = 0; level < kLevels && at.has_relative_path(); ++level, at = at.parent_path()) {
    if (!std::filesystem::exists(at / "idVendor", none)) continue;
    std::ifstream in(at / "serial");
    if (std::string serial; std::getline(in, serial)) return serial;
    return std::nullopt;
  }
  return std::nullopt;
}

/// Path to udev's link.
std::map<std::string, std::string> sockets() {
  namespace fs = std::filesystem;
  std::map<std::string, std::string> out;
  std::error_code none;
  for (const auto& link : fs::directory_iterator("/dev/serial/by-path", none)) {
    const fs::path target = fs::canonical(link.path(), none);
    if (!target.empty()) out.emplace(target.string(), link.path().string());
  }
  return out;
}

}  // namespace

std::vector<PortInfo> list_ports() {
  std::vector<PortInfo> out;
  const auto links = sockets();
  sp_port** ports = nullptr;
  if (sp_list_ports(&ports) != SP_OK) return out;
  for (sp_port** port = ports; *port != nullptr; ++port) {
    PortInfo info;
    info.path = text(sp_get_port_name(*port));
    info.description = text(sp_get_port_description(*port));
    info.usb_serial = text(sp_get_port_usb_serial(*port));
    info.usb_interface = interface_of(info.path);
    if (const auto link = links.find(info.path); link != links.end()) info.by_path = link->second;
    int vendor = 0, product = 0;
    if (sp_get_port_usb_vid_pid(*port, &vendor, &product) == SP_OK)
      info.usb_id = fmt::format("{:04x}:{:04x}", vendor, product);
    out.push_back(std::move(info));
  }
  sp_free_port_list(ports);
  return out;
}

std::string lasting_name(const PortInfo& port, std::span<const PortInfo> all) {
  const auto shares = [&](const PortInfo& other) { return other.usb_serial == port.usb_serial; };
  if (!port.usb_serial.empty() && std::count_if(all.begin(), all.end(), shares) == 1) return port.name();
  return port.by_path.empty() ? port.path : port.by_path;
}

std::string udev_rule(const PortInfo& port, std::span<const PortInfo> all, std::string_view name) {
  const std::string gives = fmt::format("SYMLINK+=\"mgt/{}\", ENV{{MGTD_PORT}}=\"1\"", name);
  if (lasting_name(port, all).starts_with("usb:"))
    return fmt::format("ENV{{ID_SERIAL_SHORT}}==\"{}\", {}", port.usb_serial, gives);
  // The ports of one converter differ by interface; converters without a number by the socket they are in.
  const auto twin = [&](const PortInfo& other) {
    return &other != &port && other.usb_serial == port.usb_serial &&
           other.usb_interface == port.usb_interface;
  };
  if (!port.usb_serial.empty() && !port.usb_interface.empty() && std::none_of(all.begin(), all.end(), twin))
    return fmt::format("ENV{{ID_SERIAL_SHORT}}==\"{}\", ENV{{ID_USB_INTERFACE_NUM}}==\"{}\", {}",
                       port.usb_serial, port.usb_interface, gives);
  if (port.by_path.empty()) return {};
  std::string socket = port.by_path.substr(port.by_path.find_last_of('/') + 1);
  if (const auto port_part = socket.rfind("-port"); port_part != std::string::npos) socket.resize(port_part);
  return fmt::format("ENV{{ID_PATH}}==\"{}\", {}", socket, gives);
}

std::optional<std::string> port_of_usb_serial(const std::string& serial, const std::string& sysfs) {
  namespace fs = std::filesystem;
  std::error_code none;
  std::vector<std::string> found;
  for (const auto& tty : fs::directory_iterator(sysfs + "/class/tty", none)) {
    if (usb_serial_of(tty.path() / "device") == serial) found.push_back(tty.path().filename());
  }
  if (found.empty()) return std::nullopt;
  return "/dev/" + *std::min_element(found.begin(), found.end());
}

std::optional<std::string> port_path(const std::string& name) {
  if (name.starts_with("usb:")) return port_of_usb_serial(name.substr(4));
  std::array<char, PATH_MAX> real{};
  return ::realpath(name.c_str(), real.data()) == nullptr ? name : std::string(real.data());
}

}  // namespace mgtd::drivers
