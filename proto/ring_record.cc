// SPDX-License-Identifier: Apache-2.0
#include "proto/ring_record.h"

#include <algorithm>

#include "proto/byte_order.h"

namespace mgtd {
namespace {

constexpr std::size_t kHead = 8 + 8;
constexpr double kLongest_s = 1e9;  // 30 years: a clock that was set meanwhile

}  // namespace

void encode_ring_bytes(const RingRecord& record, std::string& out) {
  put_little<8>(out, record.from_seq);
  put_little<8>(out, record.to_seq);
  out += record.line;
}

RawRecord frame(const RingRecord& record, std::string_view bytes) {
  return {static_cast<std::uint8_t>(record.kind), RawDirection::note, record.at, bytes};
}

std::optional<RingRecord> ring_record(const RawRecord& record) {
  if (record.direction != RawDirection::note || record.bytes.size() < kHead ||
      record.device > static_cast<std::uint8_t>(RingRecord::Kind::closed)) {
    return std::nullopt;
  }
  RingRecord out{static_cast<RingRecord::Kind>(record.device), get_little<8>(record.bytes, 0),
                 get_little<8>(record.bytes, 8), record.at, record.bytes.substr(kHead)};
  if (out.from_seq > out.to_seq || out.to_seq == UINT64_MAX) return std::nullopt;
  return out;
}

void RingHistory::add(const RingRecord& record) {
  at_ = record.at.wall;
  closed_ = record.kind == RingRecord::Kind::closed;
  if (record.kind == RingRecord::Kind::promise) {
    promised_ = record.to_seq;
  } else {
    end_ = std::max(end_, closed_ ? record.to_seq : record.to_seq + 1);
  }
  if (closed_) promised_ = end_;
}

std::uint64_t RingHistory::next_seq(WallTime now, double rate_hz) const {
  if (!at_) return 0;
  const double passed_s = 1e-9 * (static_cast<double>(now.ns) - static_cast<double>(at_->ns));
  const double epochs = std::clamp(passed_s, 0.0, kLongest_s) * rate_hz;
  return std::max(promised_, end_ + static_cast<std::uint64_t>(epochs));
}

}  // namespace mgtd
