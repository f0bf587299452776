// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <numeric>
#include <string>
#include <string_view>

/// ClientCounts says how many clients connected to a socket, and how many were turned away, and why.
namespace mgtd {

enum class DropReason : std::uint8_t {
  behind,     ///< stayed behind the stream
  unread,     ///< asked and did not read the answers
  bad_lines,  ///< lines that are no request, one after the other
  overlong,   ///< a request longer than the limit
  too_often,  ///< more requests than the limit
};
inline constexpr std::array<std::string_view, 5> kDropNames{"behind", "unread", "bad_lines", "overlong",
                                                            "too_often"};

struct ClientCounts {
  std::uint64_t clients{0};                              ///< connected now
  std::uint64_t accepted{0};                             ///< since the start
  std::uint64_t refused{0};                              ///< beyond the limit of clients
  std::array<std::uint64_t, kDropNames.size()> drops{};  ///< disconnected by us, by DropReason
  std::string last_drop;                                 ///< why, in a sentence; empty: none yet

  void drop(DropReason reason, std::string why) {
    ++drops.at(static_cast<std::size_t>(reason));
    last_drop = std::move(why);
  }
  [[nodiscard]] std::uint64_t dropped() const {
    return std::accumulate(drops.begin(), drops.end(), std::uint64_t{0});
  }
};

}  // namespace mgtd
