// SPDX-License-Identifier: Apache-2.0
#include "proto/raw_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <utility>

#include "proto/byte_order.h"

namespace mgtd {
namespace {

constexpr std::string_view kMagic{"MGTDRAW1"};
constexpr char kMark = '\xA5';
constexpr char kShortTick = '\xA6';
constexpr std::size_t kShortTickBytes = 1 + 1 + 4 + 2;
constexpr std::size_t kRecordHead = 1 + 1 + 1 + 8 + 8 + 4;
constexpr std::size_t kCrc = 4;

// A damaged file may hold any time: unsigned, so that sums may wrap.

std::uint64_t elapsed_ns(Instant from, Instant to) {
  return static_cast<std::uint64_t>(to.time_since_epoch().count()) -
         static_cast<std::uint64_t>(from.time_since_epoch().count());
}

std::int64_t later(std::int64_t ns, std::uint64_t by_ns) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(ns) + by_ns);
}

}  // namespace

std::uint32_t crc32(std::string_view bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

std::string encode_header(const RawLogHeader& header) {
  std::string text = header.rig.substr(0, 0x7000) + '\0' + header.run_id.substr(0, 0x7000);
  std::string out(kMagic);
  put_little<2>(out, text.size());
  out += text;
  put_little<kCrc>(out, crc32(out));
  return out;
}

bool RawLogEncoder::is_short(const RawRecord& record) const {
  if (record.direction != RawDirection::tick || !record.bytes.empty() || !last_) return false;
  const std::uint64_t since = elapsed_ns(last_->mono, record.at.mono);
  return since <= UINT32_MAX &&
         static_cast<std::uint64_t>(record.at.wall.ns) == static_cast<std::uint64_t>(last_->wall.ns) + since;
}

void RawLogEncoder::encode(const RawRecord& record, std::string& out) {
  const bool tick = is_short(record);
  const std::uint64_t since = tick ? elapsed_ns(last_->mono, record.at.mono) : 0;
  last_ = record.at;
  std::string_view rest = record.bytes;
  do {
    const std::string_view part = rest.substr(0, kRawRecordMax);
    rest.remove_prefix(part.size());
    const std::size_t start = out.size();
    out += tick ? kShortTick : kMark;
    put_little<1>(out, record.device);
    if (tick) {
      put_little<4>(out, since);
      put_little<2>(out, crc32(std::string_view(out).substr(start)));
      return;
    }
    put_little<1>(out, static_cast<std::uint64_t>(record.direction));
    put_little<8>(out, static_cast<std::uint64_t>(record.at.mono.time_since_epoch().count()));
    put_little<8>(out, static_cast<std::uint64_t>(record.at.wall.ns));
    put_little<4>(out, part.size());
    out += part;
    put_little<kCrc>(out, crc32(std::string_view(out).substr(start)));
  } while (!rest.empty());
}

void RawLogDecoder::feed(std::string_view bytes) {
  if (state_ == State::damaged) return;
  buffer_.erase(0, std::exchange(at_, 0));
  buffer_ += bytes;
}

std::nullopt_t RawLogDecoder::damage(std::string what) {
  state_ = State::damaged;
  damage_ = std::move(what);
  buffer_.clear();
  at_ = 0;
  return std::nullopt;
}

/// False: not yet, or damaged.
bool RawLogDecoder::take_header() {
  const std::string_view all(buffer_);
  const std::size_t known = std::min(all.size(), kMagic.size());
  if (all.substr(0, known) != kMagic.substr(0, known)) {
    damage("no journal header");
    return false;
  }
  if (all.size() < kMagic.size() + 2) return false;
  const std::size_t body = kMagic.size() + 2 + get_little<2>(all, kMagic.size());
  if (all.size() < body + kCrc) return false;
  if (crc32(all.substr(0, body)) != get_little<kCrc>(all, body)) {
    damage("the header's checksum is wrong");
    return false;
  }
  const std::string_view text = all.substr(kMagic.size() + 2, body - kMagic.size() - 2);
  const std::size_t zero = std::min(text.find('\0'), text.size());
  header_ = {std::string(text.substr(0, zero)), std::string(text.substr(std::min(zero + 1, text.size())))};
  at_ = body + kCrc;
  good_ += at_;
  state_ = State::records;
  return true;
}

std::optional<RawRecord> RawLogDecoder::next() {
  if (state_ == State::damaged || (state_ == State::header && !take_header())) return std::nullopt;
  const std::string_view rest = std::string_view(buffer_).substr(at_);
  if (rest.empty()) return std::nullopt;
  if (rest[0] == kShortTick) return take_tick(rest);
  if (rest[0] == kMark) return take_record(rest);
  return damage("a record does not begin where it should");
}

std::optional<RawRecord> RawLogDecoder::take_tick(std::string_view rest) {
  if (rest.size() < kShortTickBytes) return std::nullopt;
  if ((crc32(rest.substr(0, kShortTickBytes - 2)) & 0xFFFFU) != get_little<2>(rest, kShortTickBytes - 2)) {
    return damage("a tick's checksum is wrong");
  }
  if (!last_) return damage("a short tick has no record before it");
  const std::uint64_t since = get_little<4>(rest, 2);
  RawRecord tick;
  tick.device = static_cast<std::uint8_t>(get_little<1>(rest, 1));
  tick.direction = RawDirection::tick;
  tick.at = {Instant{Duration{later(last_->mono.time_since_epoch().count(), since)}},
             WallTime{later(last_->wall.ns, since)}};
  last_ = tick.at;
  at_ += kShortTickBytes;
  good_ += kShortTickBytes;
  return tick;
}

std::optional<RawRecord> RawLogDecoder::take_record(std::string_view rest) {
  if (rest.size() < kRecordHead) return std::nullopt;
  const std::size_t length = get_little<4>(rest, kRecordHead - 4);
  const std::uint64_t direction = get_little<1>(rest, 2);
  if (length > kRawRecordMax || direction > static_cast<std::uint64_t>(RawDirection::ended)) {
    return damage("a record's head makes no sense");
  }
  if (rest.size() < kRecordHead + length + kCrc) return std::nullopt;
  if (crc32(rest.substr(0, kRecordHead + length)) != get_little<kCrc>(rest, kRecordHead + length)) {
    return damage("a record's checksum is wrong");
  }
  RawRecord record;
  record.device = static_cast<std::uint8_t>(get_little<1>(rest, 1));
  record.direction = static_cast<RawDirection>(direction);
  record.at.mono = Instant{Duration{static_cast<std::int64_t>(get_little<8>(rest, 3))}};
  record.at.wall.ns = static_cast<std::int64_t>(get_little<8>(rest, 11));
  record.bytes = rest.substr(kRecordHead, length);
  last_ = record.at;
  at_ += kRecordHead + length + kCrc;
  good_ += kRecordHead + length + kCrc;
  return record;
}

Result<void> RawLogDecoder::finish() const {
  if (state_ == State::damaged) {
    return fail(ErrorCode::bad_input, fmt::format("{} at byte {}", damage_, good_),
                "what stands before it was read");
  }
  if (state_ == State::header) return fail(ErrorCode::bad_input, "the journal ends within its header", "");
  if (buffer_.size() > at_) {
    return fail(
        ErrorCode::bad_input,
        fmt::format("the last record is torn: {} bytes of it after byte {}", buffer_.size() - at_, good_),
        "the writer was killed; everything before is whole");
  }
  return {};
}

}  // namespace mgtd
