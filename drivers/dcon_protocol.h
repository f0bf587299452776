// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "proto/health.h"

/// DCON is the ASCII protocol of analogue input modules on RS-485; ICP DAS I-7000, Advantech ADAM-4000 and
/// Measurement Computing CB-7000 speak it. Source: user's manuals of the I-7013/I-7033 and CB-7013/7033.
///
/// Line 9600 Bd 8N1, address 01 as delivered; every line ends in CR; with the checksum switched on, two
/// hexadecimal digits stand before the CR: the low byte of the sum of all characters before them.
///
///   #AA        -> >+025.12+054.12+150.12     all channels, engineering units
///                 >-0000  >+9999             a channel below or above its range: no decimal point
///                 >4C53                      the module is set to hexadecimal: not understood here
///   $AAM       -> !AA7033                    its name
///   anything wrong -> ?AA, or silence
namespace mgtd::drivers::dcon {

inline constexpr int kDefaultBaud = 9600;
inline constexpr std::size_t kMaxChannels = 16;

/// One per channel; empty where the module says that the input is out of its range.
struct Values {
  std::vector<std::optional<double>> channels;
};
struct Name {
  std::string text;
};
struct Refusal {};  ///< ?AA

using Reply = std::variant<Values, Name, Refusal, Reject>;

/// One line without its CR. `address` is what was asked, two hexadecimal digits.
[[nodiscard]] Reply parse_reply(std::string_view line, std::string_view address, bool checksum);

/// With checksum and CR, ready to send.
[[nodiscard]] std::string command(std::string text, bool checksum);

}  // namespace mgtd::drivers::dcon
