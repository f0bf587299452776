// SPDX-License-Identifier: Apache-2.0
#include "drivers/port_list.h"

#include <fmt/format.h>
#include <libserialport.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <system_error>

namespace mgtd::drivers {
namespace {

std::string text(const char* text_or_null) { return text_or_null == nullptr ? std::string() : text_or_null; }

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

std::optional<std::string> port_path(const std::string& name) {
  if (name.starts_with("usb:")) {
    for (const PortInfo& port : list_ports()) {
      if (port.name() == name) return port.path;
    }
    return std::nullopt;
  }
  std::array<char, PATH_MAX> real{};
  return ::realpath(name.c_str(), real.data()) == nullptr ? name : std::string(real.data());
}

}  // namespace mgtd::drivers
