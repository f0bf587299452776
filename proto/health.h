// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "proto/time.h"

/// LinkHealth counts how a link to a device is doing. The counts balance at every moment:
///   bytes_in = bytes_in_frames + bytes_rejected + bytes_resync + bytes_pending.
namespace mgtd {

/// Why a candidate frame was thrown away.
enum class Reject : std::uint8_t { length, framing, checksum, number, range, sequence };
inline constexpr std::size_t kRejects = 6;
inline constexpr std::array<std::string_view, kRejects> kRejectNames{"length", "framing", "checksum",
                                                                     "number", "range",   "sequence"};

/// Life of a link, as shown to the operator.
enum class LinkState : std::uint8_t {
  absent,   ///< there is no such port
  opening,  ///< there is one, and it cannot be opened
  probing,  ///< the device is asked who it is
  live,
  silent,
  failed,
  frozen,     ///< it repeats one reading
  saturated,  ///< it is at the end of its range
  gone,       ///< the port was there and went away
};
inline constexpr std::array<std::string_view, 9> kLinkStateNames{
    "absent", "opening", "probing", "live", "silent", "failed", "frozen", "saturated", "gone"};
/// The device speaks and is heard, whatever its readings are worth.
[[nodiscard]] constexpr bool answers(LinkState state) {
  return state == LinkState::live || state == LinkState::frozen || state == LinkState::saturated;
}

struct LinkHealth {
  LinkState state{LinkState::absent};
  std::string detail;    ///< why it is not live, and what to do; or what was identified
  std::string identity;  ///< as the device named itself
  std::uint64_t bytes_in{0}, bytes_in_frames{0}, bytes_rejected{0}, bytes_resync{0}, bytes_pending{0};
  std::uint64_t bytes_out{0};
  std::uint64_t frames{0};
  std::array<std::uint64_t, kRejects> rejected{};  ///< frames by reason
  std::uint64_t opens{0}, closes{0};
  std::optional<Instant> last_frame;
  std::optional<Instant> state_since;  ///< when the state became what it is; empty: nothing happened yet

  void reject(Reject why, std::size_t bytes) {
    ++rejected[static_cast<std::size_t>(why)];
    bytes_rejected += bytes;
  }
  [[nodiscard]] bool balanced() const {
    return bytes_in == bytes_in_frames + bytes_rejected + bytes_resync + bytes_pending;
  }
};

}  // namespace mgtd
