// SPDX-License-Identifier: Apache-2.0
#include "drivers/gcs2_protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "proto/number.h"

namespace mgtd::drivers::gcs2 {
namespace {

std::string_view trimmed(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ') || text.ends_with('\r')) text.remove_suffix(1);
  return text;
}

struct KnownError {
  int number;
  std::string_view what;
  std::string_view remedy;
};

constexpr std::string_view kReportIt =
    "keep the journal of this port and report it: the daemon sent what it should not";
constexpr std::array<KnownError, 19> kErrors{{
    {1, "the controller did not understand a parameter", kReportIt},
    {2, "the controller does not know a command", "check that the controller speaks GCS 2.0"},
    {3, "a command was too long for the controller", kReportIt},
    {5, "a move was refused because the axis is not referenced or its servo is off",
     "mgt run resume makes the reference move first"},
    {7, "a target lies outside the travel of the controller",
     "set limits in the configuration within TMN?..TMX?"},
    {8, "a velocity lies outside the limits of the controller", "lower velocity_deg_per_s"},
    {10, "the motion was stopped by a command", "start again when the table is free"},
    {15, "the controller has no axis of that name", "correct axes in the configuration"},
    {17, "a parameter is out of range", "check velocity_deg_per_s and limits"},
    {23, "the axis name is not legal", "correct axes in the configuration"},
    {24, "a command had the wrong number of parameters", kReportIt},
    {25, "a number could not be read by the controller", kReportIt},
    {26, "a parameter was missing", kReportIt},
    {27, "a soft limit is out of range", "check the travel limits stored in the controller"},
    {45, "the reference move failed", "check the reference switch and that nothing blocks the table"},
    {49, "the move to the limit switch failed", "check the limit switch and that nothing blocks the table"},
    {52, "the controller reports a communication error", "check cable and baud"},
    {53, "a dynamic move is in progress", "stop the other program that moves the table"},
    {54, "the controller does not know a parameter", kReportIt},
}};

}  // namespace

std::string query(std::string_view mnemonic, std::string_view axis) {
  return axis.empty() ? fmt::format("{}\n", mnemonic) : fmt::format("{} {}\n", mnemonic, axis);
}

std::string set_servo(std::string_view axis, bool on) { return fmt::format("SVO {} {:d}\n", axis, on); }
std::string set_velocity(std::string_view axis, double deg_per_s) {
  return fmt::format("VEL {} {:.6f}\n", axis, deg_per_s);
}
std::string reference(std::string_view axis) { return fmt::format("FRF {}\n", axis); }
std::string move(std::string_view axis, double target_deg) {
  return fmt::format("MOV {} {:.6f}\n", axis, target_deg);
}

std::string printable(std::string_view message) {
  if (message == kStop) return "stop (18)";
  if (message == kAskMoving) return "05";
  if (message == kAskReady) return "07";
  return std::string(trimmed(message.substr(0, message.find('\n'))));
}

std::string form_of_value(std::string_view axis) { return fmt::format("{}=", axis); }

std::string form_of(std::string_view reply) {
  if (parse_ready(reply)) return std::string(kReadyForm);
  const bool printable = std::all_of(reply.begin(), reply.end(),
                                     [](char c) { return (c >= ' ' && c <= '~') || c == '\n' || c == '\r'; });
  if (!printable || trimmed(reply).empty()) return {};
  if (reply.find(',') != std::string_view::npos) return std::string(kIdentityForm);
  if (const auto equals = reply.find('='); equals != std::string_view::npos)
    return form_of_value(trimmed(reply.substr(0, equals)));
  return std::string(kPlainForm);
}

std::optional<double> parse_value(std::string_view reply, std::string_view axis) {
  reply = trimmed(reply);
  const std::size_t equals = reply.find('=');
  if (equals == std::string_view::npos || trimmed(reply.substr(0, equals)) != axis) return std::nullopt;
  return parse_number(trimmed(reply.substr(equals + 1)));
}

std::optional<bool> parse_flag(std::string_view reply, std::string_view axis) {
  const std::optional<double> value = parse_value(reply, axis);
  if (!value || (*value != 0.0 && *value != 1.0)) return std::nullopt;
  return *value == 1.0;
}

std::optional<int> parse_error(std::string_view reply) {
  const std::optional<std::int64_t> number = parse_integer(trimmed(reply));
  if (!number || *number < -100'000 || *number > 100'000) return std::nullopt;
  return static_cast<int>(*number);
}

std::optional<std::uint32_t> parse_moving(std::string_view reply) {
  reply = trimmed(reply);
  if (reply.empty() || reply.size() > 8) return std::nullopt;
  std::uint32_t mask = 0;
  for (const char c : reply) {
    const auto digit = std::string_view("0123456789ABCDEFabcdef").find(c);
    if (digit == std::string_view::npos) return std::nullopt;
    mask = mask * 16 + static_cast<std::uint32_t>(digit < 16 ? digit : digit - 6);
  }
  return mask;
}

std::optional<bool> parse_ready(std::string_view reply) {
  if (reply == "\xB1") return true;
  if (reply == "\xB0") return false;
  return std::nullopt;
}

std::vector<std::string> parse_axes(std::string_view reply) {
  std::vector<std::string> axes;
  while (!reply.empty()) {
    const std::size_t end = reply.find('\n');
    const std::string_view line = trimmed(reply.substr(0, end));
    if (!line.empty()) axes.emplace_back(line);
    reply.remove_prefix(end == std::string_view::npos ? reply.size() : end + 1);
  }
  return axes;
}

ErrorText explain(int error) {
  for (const KnownError& known : kErrors) {
    if (known.number == error)
      return {fmt::format("{} (GCS error {})", known.what, error), std::string(known.remedy)};
  }
  return {fmt::format("the controller reports GCS error {}", error),
          "look the number up in the controller's manual"};
}

}  // namespace mgtd::drivers::gcs2
