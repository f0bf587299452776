// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proto/stream_class.h"
#include "proto/time.h"

/// The ring holds the newest lines of the stream, encoded once for all clients. Records are numbered from 0
/// on and stay at their number; the oldest are overwritten. Slots keep their memory, up to twice what their
/// line needs: among lines of like length pushing allocates nothing once every slot has held one, and a long
/// line now and then does not make the ring grow.
namespace mgtd::daemon::serve {

struct StreamRecord {
  StreamClass stream_class{StreamClass::tensor};
  std::uint64_t from_seq{
      0};                   ///< first epoch it speaks of; of STATUS, RUN, SENSORS: the epoch that comes next
  std::uint64_t to_seq{0};  ///< last epoch it speaks of; of STATUS, RUN, SENSORS as from_seq
  Instant at{};             ///< of a TENSOR: the sample's time
  std::string line;         ///< with its line end
};

class SampleRing {
 public:
  /// `next_seq`: the first epoch that will be pushed, when earlier ones were in another life.
  explicit SampleRing(std::size_t capacity, std::uint64_t next_seq = 0);

  void push_sample(std::uint64_t seq, Instant at, std::string_view line);
  void push_gap(std::uint64_t from_seq, std::uint64_t to_seq, std::string_view line);
  void push_other(StreamClass stream_class, std::string_view line);

  /// Records begin() .. end() - 1 are held.
  [[nodiscard]] std::uint64_t begin() const;
  [[nodiscard]] std::uint64_t end() const { return end_; }
  [[nodiscard]] std::size_t capacity() const { return slots_.size(); }
  [[nodiscard]] const StreamRecord& at(std::uint64_t number) const { return slots_[number % slots_.size()]; }

  /// The epoch that comes next.
  [[nodiscard]] std::uint64_t next_seq() const { return next_seq_; }
  /// The first epoch that no record before begin() spoke of.
  [[nodiscard]] std::uint64_t oldest_seq() const;
  /// The first record held that speaks of epoch seq or a later one; end() when none does.
  [[nodiscard]] std::uint64_t find_seq(std::uint64_t seq) const;

 private:
  void push(StreamClass stream_class, std::uint64_t from_seq, std::uint64_t to_seq, Instant at,
            std::string_view line);

  std::vector<StreamRecord> slots_;
  std::uint64_t end_{0};
  std::uint64_t next_seq_{0};
};

}  // namespace mgtd::daemon::serve
