// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// GCS 2.0 is the language of Physik Instrumente's motion controllers, among them those of the non-magnetic
/// PILine piezo stages. Sources: PI's own PIPython (gcsmessages, gcs2commands, gcserror) and the EPICS module
/// motorPIGCS2.
///
/// Line 8N1, 115200 Bd typical. Commands end in LF. A set command gets no reply: only ERR? tells whether it
/// was taken. Reply lines end in LF; in a reply of several lines all but the last end in space LF.
///
///   send           reply               meaning
///   *IDN?          text                identity
///   SAI?           one axis a line     axes
///   SVO a 1|0      -                   servo on / off
///   FRF a          -                   reference move;  FRF? a -> a=1 when referenced
///   VEL a v        -                   velocity, deg/s
///   MOV a x        -                   absolute target, deg
///   POS? a         a=90.0000000        position, deg
///   ONT? a         a=1                 on target
///   TMN? a, TMX? a a=...               travel limits, deg
///   ERR?           0                   last error; reading clears it
///   byte 05        hex mask            axes in motion, 0 = none
///   byte 07        byte B1 / B0        ready / busy
///   byte 18        -                   stop everything at once; sets error 10
///
/// Not verified on hardware: whether an LF follows B1/B0 (both forms are read).
namespace mgtd::drivers::gcs2 {

inline constexpr int kDefaultBaud = 115200;
inline constexpr std::string_view kStop{"\x18"};
inline constexpr std::string_view kAskMoving{"\x05"};
inline constexpr std::string_view kAskReady{"\x07"};
inline constexpr int kStoppedByCommand = 10;

[[nodiscard]] std::string query(std::string_view mnemonic, std::string_view axis = {});
[[nodiscard]] std::string set_servo(std::string_view axis, bool on);
[[nodiscard]] std::string set_velocity(std::string_view axis, double deg_per_s);
[[nodiscard]] std::string reference(std::string_view axis);
[[nodiscard]] std::string move(std::string_view axis, double target_deg);

/// A message as an operator may read it.
[[nodiscard]] std::string printable(std::string_view message);

/// What a reply looks like, which is all that tells which question it may answer: "identity" (commas), "1="
/// (the value of axis 1), "ready", "plain" (numbers, masks, names of axes). Empty: no reply looks so.
[[nodiscard]] std::string form_of(std::string_view reply);
[[nodiscard]] std::string form_of_value(std::string_view axis);
inline constexpr std::string_view kIdentityForm{"identity"}, kPlainForm{"plain"}, kReadyForm{"ready"};

/// Replies. Empty when the text is not of the form.
[[nodiscard]] std::optional<double> parse_value(std::string_view reply, std::string_view axis);  ///< "1=2.5"
[[nodiscard]] std::optional<bool> parse_flag(std::string_view reply, std::string_view axis);     ///< "1=1"
[[nodiscard]] std::optional<int> parse_error(std::string_view reply);                            ///< "0"
[[nodiscard]] std::optional<std::uint32_t> parse_moving(std::string_view reply);                 ///< "1F"
[[nodiscard]] std::optional<bool> parse_ready(std::string_view reply);                           ///< byte B1
[[nodiscard]] std::vector<std::string> parse_axes(std::string_view reply);

/// What an error number means and what the operator can do.
struct ErrorText {
  std::string what;
  std::string remedy;
};
[[nodiscard]] ErrorText explain(int error);

}  // namespace mgtd::drivers::gcs2
