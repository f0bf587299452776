// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

#include "proto/error.h"
#include "proto/stream_class.h"

/// A client of the live stream asks for samples with this request, one JSON object per line:
///
///   {"watch":{"class":["TENSOR","STATUS","RUN","SENSORS"],"rate_hz":10,"from_seq":null}}
///
/// A new watch replaces the one before. Left out or null: every class, every sample, from now on. An empty
/// list of classes stops the stream. Decimation (`rate_hz`) concerns TENSOR only.
namespace mgtd {

inline constexpr std::size_t kWatchLineLimit = 4096;
inline constexpr double kWatchRateMin_hz = 0.001;
inline constexpr double kWatchRateMax_hz = 10'000;

struct WatchRequest {
  StreamClasses classes{StreamClasses::all()};
  std::optional<double> rate_hz;          ///< empty: every sample
  std::optional<std::uint64_t> from_seq;  ///< first sample wanted, as far as the daemon still holds it
  bool operator==(const WatchRequest&) const = default;
};

/// Refuses broken JSON (with the position), an unknown key, class or type, a rate outside the limits, and
/// whatever is no watch, commands included: the stream is read-only.
[[nodiscard]] Result<WatchRequest> parse_watch(std::string_view line);

/// The request as a client sends it, without the line end.
[[nodiscard]] std::string encode(const WatchRequest& request);

}  // namespace mgtd
