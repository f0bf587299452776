// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "proto/raw_log.h"
#include "proto/time.h"

/// A RingRecord is one line of the stream as it is kept on disk, in the frame of the journal (raw_log.h):
/// device = kind, direction = note, stamp = the sample's time (of the others: when it was written), bytes =
///
///     u64 from_seq, u64 to_seq, line without its end         little endian
///
/// The numbers of the stream are never used twice. What one life of the daemon may have used is known to the
/// next from `promise`, written ahead of time and synced, and from `closed`, written last.
namespace mgtd {

struct RingRecord {
  enum class Kind : std::uint8_t {
    sample,
    gap,
    promise,  ///< no number from to_seq on is used before another promise
    closed,   ///< the daemon ended in order; to_seq was not used
  };
  Kind kind{Kind::sample};
  std::uint64_t from_seq{0};
  std::uint64_t to_seq{0};
  Stamp at;
  std::string_view line;  ///< valid as long as the record it was read from
};

/// Appends to `out` what follows the frame's head.
void encode_ring_bytes(const RingRecord& record, std::string& out);
/// `bytes`: what encode_ring_bytes() gave.
[[nodiscard]] RawRecord frame(const RingRecord& record, std::string_view bytes);
/// Nothing when the record is none of the ring's.
[[nodiscard]] std::optional<RingRecord> ring_record(const RawRecord& record);

/// What is known of the numbers used so far, from the records in their order.
class RingHistory {
 public:
  void add(const RingRecord& record);

  /// The first number for a new life at `now`: after all that may have been used, and as much later as time
  /// has passed at `rate_hz`.
  [[nodiscard]] std::uint64_t next_seq(WallTime now, double rate_hz) const;
  /// The number after the last line held.
  [[nodiscard]] std::uint64_t end_seq() const { return end_; }
  [[nodiscard]] bool empty() const { return !at_; }
  [[nodiscard]] bool closed() const { return closed_; }

 private:
  std::uint64_t end_{0}, promised_{0};
  std::optional<WallTime> at_;
  bool closed_{false};
};

}  // namespace mgtd
