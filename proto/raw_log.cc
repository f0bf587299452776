// SPDX-License-Identifier: Apache-2.0
#include "proto/raw_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace mgtd {
namespace {

constexpr std::string_view kMagic{"MGTDRAW1"};
constexpr char kMark = '\xA5';
constexpr std::size_t kRecordHead = 1 + 1 + 1 + 8 + 8 + 4;
constexpr std::size_t kCrc = 4;

constexpr std::array<std::uint32_t, 256> crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1U) != 0 ? 0xEDB88320U ^ (c >> 1U) : c >> 1U;
    table[i] = c;
  }
  return table;
}
constexpr auto kCrcTable = crc_table();

void put(std::string& out, std::uint64_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) out += static_cast<char>((value >> (8 * i)) & 0xFFU);
}

std::uint64_t get(std::string_view from, std::size_t at, std::size_t bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) {
    value |= std::uint64_t{static_cast<unsigned char>(from[at + i])} << (8 * i);
  }
  return value;
}

}  // namespace

std::uint32_t crc32(std::string_view bytes, std::uint32_t before) {
  std::uint32_t c = ~before;
  for (const char byte : bytes) c = kCrcTable[(c ^ static_cast<unsigned char>(byte)) & 0xFFU] ^ (c >> 8U);
  return ~c;
}

std::string encode_header(const RawLogHeader& header) {
  std::string text = header.rig.substr(0, 0x7000) + '\0' + header.run_id.substr(0, 0x7000);
  std::string out(kMagic);
  put(out, text.size(), 2);
  out += text;
  put(out, crc32(out), kCrc);
  return out;
}

void encode_record(const RawRecord& record, std::string& out) {
  std::string_view rest = record.bytes;
  do {
    const std::string_view part = rest.substr(0, kRawRecordMax);
    rest.remove_prefix(part.size());
    const std::size_t start = out.size();
    out += kMark;
    put(out, record.device, 1);
    put(out, static_cast<std::uint64_t>(record.direction), 1);
    put(out, static_cast<std::uint64_t>(record.at.mono.time_since_epoch().count()), 8);
    put(out, static_cast<std::uint64_t>(record.at.wall.ns), 8);
    put(out, part.size(), 4);
    out += part;
    put(out, crc32(std::string_view(out).substr(start)), kCrc);
  } while (!rest.empty());
}

void RawLogDecoder::feed(std::string_view bytes) {
  if (state_ == State::damaged) return;
  buffer_.erase(0, std::exchange(at_, 0));
  buffer_ += bytes;
}

void RawLogDecoder::damage(std::string what) {
  state_ = State::damaged;
  damage_ = std::move(what);
  buffer_.clear();
  at_ = 0;
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
  const std::size_t body = kMagic.size() + 2 + get(all, kMagic.size(), 2);
  if (all.size() < body + kCrc) return false;
  if (crc32(all.substr(0, body)) != get(all, body, kCrc)) {
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
  if (!rest.empty() && rest[0] != kMark) {
    damage("a record does not begin where it should");
    return std::nullopt;
  }
  if (rest.size() < kRecordHead) return std::nullopt;
  const std::size_t length = get(rest, kRecordHead - 4, 4);
  const std::uint64_t direction = get(rest, 2, 1);
  if (length > kRawRecordMax || direction > static_cast<std::uint64_t>(RawDirection::closed)) {
    damage("a record's head makes no sense");
    return std::nullopt;
  }
  if (rest.size() < kRecordHead + length + kCrc) return std::nullopt;
  if (crc32(rest.substr(0, kRecordHead + length)) != get(rest, kRecordHead + length, kCrc)) {
    damage("a record's checksum is wrong");
    return std::nullopt;
  }
  RawRecord record;
  record.device = static_cast<std::uint8_t>(get(rest, 1, 1));
  record.direction = static_cast<RawDirection>(direction);
  record.at.mono = Instant{Duration{static_cast<std::int64_t>(get(rest, 3, 8))}};
  record.at.wall.ns = static_cast<std::int64_t>(get(rest, 11, 8));
  record.bytes = rest.substr(kRecordHead, length);
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
