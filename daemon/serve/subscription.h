// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "daemon/serve/sample_ring.h"
#include "proto/ring_record.h"
#include "proto/watch_request.h"

/// A Subscription knows what one client of the stream asked for and how far it has read. Pure: lines go from
/// the ring to a buffer here, sockets are elsewhere.
///
/// A client that asks for samples older than the ring's is `behind`: the owner shows it what is on disk by
/// take(), and catch_up() when there is no more; then it goes on in the ring.
///
/// A client that the ring has overtaken is told by a GAP which epochs it lost ("client too slow") and goes on
/// with the newest sample. Overtaken three times without keeping up for a ring length in between, it has
/// stayed behind and is to be disconnected.
namespace mgtd::daemon::serve {

class Subscription {
 public:
  static constexpr int kStrikes = 3;

  /// Replaces the wishes. What has to be said at once (epochs asked for and no longer held, a from_seq that
  /// lies ahead) is appended to `out`. `on_disk`: the first epoch that is kept there.
  void watch(const WatchRequest& request, const SampleRing& ring, std::string& out,
             std::optional<std::uint64_t> on_disk = std::nullopt);

  /// The epoch to be read from disk next; nothing when the ring has the rest.
  [[nodiscard]] std::optional<std::uint64_t> behind() const;
  /// A line from the disk, in order. False: the ring has the rest.
  bool take(const RingRecord& record, const SampleRing& ring, std::string& out);
  /// There is no more on disk.
  void catch_up(const SampleRing& ring, std::string& out);

  /// Appends lines that are due until `out` holds at least `limit` bytes or nothing more is due.
  void fill(const SampleRing& ring, std::string& out, std::size_t limit);

  [[nodiscard]] bool watching() const { return request_.classes.any(); }
  [[nodiscard]] std::uint64_t gaps() const { return gaps_; }
  /// Overtaken too often, or by so many ring lengths that it must be dead.
  [[nodiscard]] bool stays_behind(const SampleRing& ring) const;

 private:
  [[nodiscard]] bool wanted(StreamClass stream_class, Instant at);
  [[nodiscard]] bool is_due(Instant at);
  void skip_lost(const SampleRing& ring, std::string& out);
  /// Of epochs from_seq .. end_seq - 1.
  void tell_gap(std::uint64_t from_seq, std::uint64_t end_seq, const char* why, std::string& out);

  WatchRequest request_{StreamClasses{}, std::nullopt, std::nullopt};
  std::uint64_t cursor_{0};         ///< number of the next record to look at
  std::uint64_t next_seq_{0};       ///< epoch after the last one looked at
  std::optional<Instant> due_;      ///< of the next sample to take, when decimating
  std::optional<Instant> last_at_;  ///< of the newest sample, taken or not
  bool behind_{false};
  std::uint64_t gaps_{0};
  int strikes_{0};
  std::uint64_t kept_up_{0};  ///< records looked at since it was last overtaken
};

}  // namespace mgtd::daemon::serve
