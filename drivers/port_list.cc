// SPDX-License-Identifier: Apache-2.0
#include "drivers/port_list.h"

#include <fmt/format.h>
#include <libserialport.h>

#include <array>
#include <climits>
#include <cstdlib>

namespace mgtd::drivers {
namespace {

std::string text(const char* text_or_null) { return text_or_null == nullptr ? std::string() : text_or_null; }

}  // namespace

std::vector<PortInfo> list_ports() {
  std::vector<PortInfo> out;
  sp_port** ports = nullptr;
  if (sp_list_ports(&ports) != SP_OK) return out;
  for (sp_port** port = ports; *port != nullptr; ++port) {
    PortInfo info;
    info.path = text(sp_get_port_name(*port));
    info.description = text(sp_get_port_description(*port));
    info.usb_serial = text(sp_get_port_usb_serial(*port));
    int vendor = 0, product = 0;
    if (sp_get_port_usb_vid_pid(*port, &vendor, &product) == SP_OK)
      info.usb_id = fmt::format("{:04x}:{:04x}", vendor, product);
    out.push_back(std::move(info));
  }
  sp_free_port_list(ports);
  return out;
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
