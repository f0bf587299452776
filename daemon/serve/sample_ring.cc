// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/sample_ring.h"

#include <algorithm>

namespace mgtd::daemon::serve {
namespace {

/// Memory for a line of so many bytes, and no more than twice as much: a slot that once held a STATUS, five
/// times as long as a sample, does not keep it. The spare eighth is for lines that differ by a few digits.
void make_room(std::string& slot, std::size_t bytes) {
  if (slot.capacity() >= bytes && slot.capacity() <= 2 * bytes) return;
  std::string fresh;
  fresh.reserve(bytes + bytes / 8);
  slot.swap(fresh);
}

}  // namespace

SampleRing::SampleRing(std::size_t capacity, std::uint64_t next_seq)
    : slots_(std::max<std::size_t>(capacity, 1)), next_seq_(next_seq) {}

void SampleRing::push(StreamClass stream_class, std::uint64_t from_seq, std::uint64_t to_seq, Instant at,
                      std::string_view line) {
  StreamRecord& slot = slots_[end_ % slots_.size()];
  slot.stream_class = stream_class;
  slot.from_seq = from_seq;
  slot.to_seq = to_seq;
  slot.at = at;
  make_room(slot.line, line.size() + 1);
  slot.line.assign(line);
  slot.line += '\n';
  ++end_;
}

void SampleRing::push_sample(std::uint64_t seq, Instant at, std::string_view line) {
  push(StreamClass::tensor, seq, seq, at, line);
  next_seq_ = seq + 1;
}

void SampleRing::push_gap(std::uint64_t from_seq, std::uint64_t to_seq, std::string_view line) {
  push(StreamClass::gap, from_seq, to_seq, {}, line);
  next_seq_ = to_seq + 1;
}

void SampleRing::push_other(StreamClass stream_class, std::string_view line) {
  push(stream_class, next_seq_, next_seq_, {}, line);
}

std::uint64_t SampleRing::begin() const { return end_ - std::min<std::uint64_t>(end_, slots_.size()); }

std::uint64_t SampleRing::oldest_seq() const { return end_ == 0 ? next_seq_ : at(begin()).from_seq; }

std::uint64_t SampleRing::find_seq(std::uint64_t seq) const {
  std::uint64_t low = begin();
  std::uint64_t high = end_;
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (at(middle).to_seq < seq) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

}  // namespace mgtd::daemon::serve
