// SPDX-License-Identifier: Apache-2.0
#include "drivers/identity.h"

#include <fmt/format.h>

#include <algorithm>

namespace mgtd::drivers {
namespace {

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1));
}

}  // namespace

std::string read_serial(Settings& settings) {
  std::string serial = settings.text("serial", "");
  if (trimmed(serial) != serial)
    settings.object("serial", "must be the serial number as the device tells it, without spaces around it");
  return serial;
}

Result<void> check_serial(std::string_view stated, std::string_view reported) {
  if (stated.empty() || stated == reported) return {};
  if (reported.empty()) {
    return fail(ErrorCode::refused,
                fmt::format("the device does not tell its serial number, and it should be {}", stated),
                "look which device is on this port; without 'serial' in the configuration any is accepted");
  }
  return fail(ErrorCode::refused,
              fmt::format("wrong device on the port: its serial number is {}, not {}", reported, stated),
              "exchange the plugs or the ports of the configuration; if the device was replaced, correct "
              "'serial', and calibrate anew");
}

std::string serial_after_sn(std::string_view line) {
  const auto at = line.rfind("SN");
  return trimmed(at == std::string_view::npos ? line : line.substr(at + 2));
}

std::string serial_of_idn(std::string_view line) {
  for (int field = 0; field < 2; ++field) {
    const auto comma = line.find(',');
    if (comma == std::string_view::npos) return {};
    line.remove_prefix(comma + 1);
  }
  return trimmed(line.substr(0, line.find(',')));
}

std::string serial_of_gsm(std::string_view header) {
  const auto model = header.find("GSM");
  if (model == std::string_view::npos) return {};
  header.remove_prefix(std::min(header.size(), header.find(' ', model)));
  const std::string rest = trimmed(header);
  return rest.substr(0, rest.find(' '));
}

}  // namespace mgtd::drivers
