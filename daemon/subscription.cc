// SPDX-License-Identifier: Apache-2.0
#include "daemon/subscription.h"

#include <fmt/format.h>

#include <algorithm>

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
  last_at_.reset();
  strikes_ = 0;
  kept_up_ = 0;
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

/// The sample nearest to each due time is taken; nearest, since real samples jitter about their grid.
bool Subscription::is_due(Instant at) {
  const Duration period = from_seconds(1.0 / *request_.rate_hz);
  const Duration interval = last_at_ ? at - *last_at_ : Duration{0};
  last_at_ = at;
  if (due_ && at + std::min(interval, period) / 2 < *due_) return false;
  due_ = !due_ || at > *due_ + period ? at + period : *due_ + period;
  return true;
}

bool Subscription::wanted(const StreamRecord& record) {
  if (!request_.classes.has(record.stream_class)) return false;
  return record.stream_class != StreamClass::tensor || !request_.rate_hz || is_due(record.at);
}

void Subscription::skip_lost(const SampleRing& ring, std::string& out) {
  strikes_ = kept_up_ < ring.capacity() ? strikes_ + 1 : 1;
  kept_up_ = 0;
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
  for (; cursor_ < ring.end() && out.size() < limit; ++cursor_, ++kept_up_) {
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
