// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/subscription.h"

#include <fmt/format.h>

#include <algorithm>

#include "proto/stream_codec.h"

namespace mgtd::daemon::serve {

namespace {

constexpr const char* kNotRecorded = "not recorded: the disk refused";

}  // namespace

void Subscription::tell_gap(std::uint64_t from_seq, std::uint64_t end_seq, const char* why,
                            std::string& out) {
  if (!request_.classes.has(StreamClass::gap) || from_seq >= end_seq) return;
  out += encode(Gap{from_seq, end_seq - 1, {}, why});
  out += '\n';
}

void Subscription::watch(const WatchRequest& request, const SampleRing& ring, std::string& out,
                         std::optional<std::uint64_t> on_disk) {
  request_ = request;
  behind_ = false;
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
                     "that number is not of this daemon's stream; it goes on from now"});
    out += '\n';
    return;
  }
  behind_ = on_disk && std::max(*on_disk, from_seq) < ring.oldest_seq();
  const std::uint64_t held = behind_ ? *on_disk : ring.oldest_seq();
  tell_gap(from_seq, held, "no longer held", out);
  next_seq_ = std::max(from_seq, held);
  if (!behind_) cursor_ = ring.find_seq(from_seq);
}

std::optional<std::uint64_t> Subscription::behind() const {
  return behind_ ? std::optional(next_seq_) : std::nullopt;
}

bool Subscription::take(const RingRecord& record, const SampleRing& ring, std::string& out) {
  if (record.to_seq < next_seq_) return behind_;
  tell_gap(next_seq_, record.from_seq, kNotRecorded, out);
  const bool is_sample = record.kind == RingRecord::Kind::sample;
  if (wanted(is_sample ? StreamClass::tensor : StreamClass::gap, record.at.mono)) {
    out += record.line;
    out += '\n';
  }
  next_seq_ = record.to_seq + 1;
  cursor_ = ring.end();  // it takes what it gets: not dead
  if (next_seq_ >= ring.oldest_seq()) catch_up(ring, out);
  return behind_;
}

void Subscription::catch_up(const SampleRing& ring, std::string& out) {
  behind_ = false;
  tell_gap(next_seq_, ring.oldest_seq(), kNotRecorded, out);
  next_seq_ = std::max(next_seq_, ring.oldest_seq());
  cursor_ = ring.find_seq(next_seq_);
}

/// The sample nearest to each due time is taken; nearest, since real samples jitter about their grid.
bool Subscription::is_due(Instant at) {
  const Duration period = from_seconds(1.0 / *request_.rate_hz);
  if (last_at_ && at < *last_at_) due_.reset();  // another life of the host
  const Duration interval = last_at_ && due_ ? at - *last_at_ : Duration{0};
  last_at_ = at;
  if (due_ && at + std::min(interval, period) / 2 < *due_) return false;
  due_ = !due_ || at > *due_ + period ? at + period : *due_ + period;
  return true;
}

bool Subscription::wanted(StreamClass stream_class, Instant at) {
  if (!request_.classes.has(stream_class)) return false;
  return stream_class != StreamClass::tensor || !request_.rate_hz || is_due(at);
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
    if (wanted(record.stream_class, record.at)) out += record.line;
    next_seq_ = record.stream_class == StreamClass::tensor || record.stream_class == StreamClass::gap
                    ? record.to_seq + 1
                    : next_seq_;
  }
}

bool Subscription::stays_behind(const SampleRing& ring) const {
  return watching() &&
         (strikes_ >= kStrikes || ring.end() - cursor_ > (1 + kStrikes) * std::uint64_t{ring.capacity()});
}

}  // namespace mgtd::daemon::serve
