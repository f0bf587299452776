// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "tests/rig/effect.h"

/// A Fault is something that goes wrong with a cable or an instrument on demand.
///   unplug PORT [for S]    the port vanishes; it comes back after S simulated seconds, or by `restore`
///   garbage PORT           200 random bytes on the line
///   torn PORT [for S]      bytes get lost on the line, one in a hundred
///   half PORT [for S]      every other line ends in its middle
///   twice PORT [for S]     every line comes twice
///   swap PORT [for S]      neighbouring lines change places
///   freeze PORT [for S]    the instrument repeats its last value; the table jams
///   stall PORT [for S]     the instrument neither speaks nor listens
///   mute PORT [for S]      it listens and obeys, and says nothing
///   late PORT [for S]      what it says arrives 0.4 to 2 s late, in its order
///   saturate PORT [for S]  the instrument is at the end of its range
///   clock PORT             its clock jumps 3 s ahead
///   rate PORT              it measures half as often
///   slow PORT [for S]      its oscillator runs 1 % slow
///   step PORT [for S]      its bytes are delivered every 16 ms
///   power PORT [for S]     without current, 2 s long when nothing else is said; it forgets what it was told
///   stranger PORT [for S]  unplugged, and after a second the cable leads to a satellite receiver
///   exchange PORT PORT [for S]  the plugs of two fluxgates change places; each is out for a second
///   turn PORT [for S]      the sensor is turned by a quarter about its z, as well as a hand can: 0.7 deg
///   runaway table [for S]    the azimuth turns on and on, whatever it is told
///   backwards table [for S]  the axes turn the wrong way, and say that they are there
///   limit table [for S]      every motion ends at a limit switch
///   restore PORT             all of it ends
///
/// A fault of an instrument (freeze, stall, saturate, clock, rate, power, turn) goes with the instrument when
/// its plug is in another port.
/// Ports: fluxgate1 .. fluxgate4 (one for each sensor of the array), table, scalar, auxiliary.
namespace mgtd::rig {

/// fluxgate1, fluxgate2, ... table, scalar, auxiliary.
[[nodiscard]] std::vector<std::string> port_names(std::size_t sensors);

enum class FaultKind {
  unplug,
  garbage,
  torn,
  half,
  twice,
  swap,
  freeze,
  stall,
  mute,
  late,
  saturate,
  clock,
  rate,
  slow,
  step,
  power,
  stranger,
  exchange,
  turn,
  runaway,
  backwards,
  limit,
  restore
};

struct Fault {
  FaultKind kind{FaultKind::restore};
  std::string port;
  std::string other{};  ///< of exchange
  std::optional<double> for_s;
};

inline constexpr double kPowerOff_s = 2;  ///< when nothing else is said

inline constexpr const char* kFaultUsage =
    "unplug|torn|half|twice|swap|freeze|stall|mute|late|saturate|slow|step|power|stranger|turn PORT [for "
    "SECONDS], "
    "exchange PORT PORT [for SECONDS], "
    "runaway|backwards|limit table [for SECONDS], or garbage|clock|rate|restore PORT";

[[nodiscard]] tl::expected<Fault, std::string> parse_fault(std::string_view text,
                                                           std::size_t sensors = kCross);

}  // namespace mgtd::rig
