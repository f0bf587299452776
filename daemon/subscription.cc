// SPDX-License-Identifier: Apache-2.0
#include "daemon/subscription.h"

#include <fmt/format.h>

#include "proto/stream_codec.h"

namespace mgtd::daemon {

void Subscription::tell_gap(std::uint64_t from_seq, std::uint64_t end_seq, const char* why,
                            std::string& out) {
  if (!request_.classes.has(StreamClass::gap) || from_seq >= end_seq) return;
  out += encode(Gap{from_seq, end_seq - 1, {}, why});
  out += '\n';
}

void Subscription::watch(const WatchRequest& request, const SampleRing& ring, std::string& out) {
  request_ = request;
  due_.reset();
  strikes_ = 0;
  cursor_ = ring.end();
  next_seq_ = ring.next_seq();
  if (!request.from_seq) return;
  const std::uint64_t from_seq = *request.from_seq;
  if (from_seq > ring.next_seq()) {
    out +=
        encode(Error{ErrorCode::bad_input,
                     fmt::format("from_seq {} lies ahead of the next sample, {}", from_seq, ring.next_seq()),
                     "the daemon has started anew since that number was seen; the stream goes on from now"});
    out += '\n';
    return;
  }
  tell_gap(from_seq, ring.oldest_seq(), "no longer held", out);
  cursor_ = ring.find_seq(from_seq);
  next_seq_ = from_seq;
}

bool Subscription::wanted(const StreamRecord& record) {
  if (!request_.classes.has(record.stream_class)) return false;
  if (record.stream_class != StreamClass::tensor || !request_.rate_hz) return true;
  const Duration period = from_seconds(1.0 / *request_.rate_hz);
  // A quarter period of tolerance: samples that jitter about a due time are taken evenly.
  if (due_ && record.at + period / 4 < *due_) return false;
  due_ = !due_ || record.at > *due_ + period ? record.at + period : *due_ + period;
  return true;
}

void Subscription::skip_lost(const SampleRing& ring, std::string& out) {
  const bool soon_again = strikes_ > 0 && ring.end() - struck_at_ <= 2 * ring.capacity();
  strikes_ = soon_again ? strikes_ + 1 : 1;
  struck_at_ = ring.end();
  ++gaps_;
  tell_gap(next_seq_, ring.next_seq(), "client too slow", out);
  cursor_ = ring.end();
  next_seq_ = ring.next_seq();
}

void Subscription::fill(const SampleRing& ring, std::string& out, std::size_t limit) {
  if (!watching()) {
    cursor_ = ring.end();
    next_seq_ = ring.next_seq();
    return;
  }
  if (cursor_ < ring.begin()) skip_lost(ring, out);
  for (; cursor_ < ring.end() && out.size() < limit; ++cursor_) {
    const StreamRecord& record = ring.at(cursor_);
    if (wanted(record)) out += record.line;
    next_seq_ = record.stream_class == StreamClass::tensor || record.stream_class == StreamClass::gap
                    ? record.to_seq + 1
                    : next_seq_;
  }
}

bool Subscription::stays_behind(const SampleRing& ring) const {
  return watching() &&
         (strikes_ >= kStrikes || ring.end() - cursor_ > (1 + kStrikes) * std::uint64_t{ring.capacity()});
}

}  // namespace mgtd::daemon
