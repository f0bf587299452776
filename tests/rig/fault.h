// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

/// What can go wrong with a cable or an instrument, on demand.
///   unplug PORT [for S]    the port vanishes; it comes back after S simulated seconds, or by `restore`
///   garbage PORT           200 random bytes on the line
///   torn PORT [for S]      bytes get lost on the line, one in a hundred
///   freeze PORT [for S]    the instrument repeats its last value; the table jams
///   stall PORT [for S]     the instrument neither speaks nor listens
///   saturate PORT [for S]  the instrument is at the end of its range
///   clock PORT             its clock jumps 3 s ahead
///   restore PORT           all of it ends
/// Ports: fluxgate1 .. fluxgate4, table, scalar, auxiliary.
namespace mgtd::rig {

inline constexpr std::array<std::string_view, 7> kPortNames{
    "fluxgate1", "fluxgate2", "fluxgate3", "fluxgate4", "table", "scalar", "auxiliary"};

enum class FaultKind { unplug, garbage, torn, freeze, stall, saturate, clock, restore };

struct Fault {
  FaultKind kind{FaultKind::restore};
  std::string port;
  std::optional<double> for_s;
};

inline constexpr const char* kFaultUsage =
    "unplug|torn|freeze|stall|saturate PORT [for SECONDS], or garbage|clock|restore PORT";

[[nodiscard]] tl::expected<Fault, std::string> parse_fault(std::string_view text);

}  // namespace mgtd::rig
