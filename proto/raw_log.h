// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "proto/error.h"
#include "proto/time.h"

/// The journal of raw bytes holds what went over every wire, exactly as it did, and what else the stream was
/// made from (journal_note.h). Framing only; no file. The stream's own samples on disk have the same frame
/// (ring_record.h).
///
///     file    header (record | tick)*
///     header  "MGTDRAW1" u16 length, text (rig and run), u32 crc of all before
///     record  u8 0xA5, u8 device, u8 direction, i64 mono_ns, i64 wall_ns, u32 length, bytes, u32 crc of the
///             record before it
///     tick    u8 0xA6, u8 device, u32 ns since the record or tick before, u16 low half of the crc of the six
///
/// Little endian; crc is CRC-32 (IEEE 802.3). The short tick stands where both clocks moved by the same; else
/// a tick is a record without bytes. A file that ends within a record was torn by a crash: everything before
/// is good. A record whose crc is wrong ends the decoding: what follows cannot be trusted to be framed.
namespace mgtd {

enum class RawDirection : std::uint8_t {
  received,
  sent,
  opened,  ///< the port, no bytes
  closed,
  tick,   ///< the device was told the time, no bytes
  note,   ///< what happened beside the wires (journal_note.h)
  ended,  ///< the device was asked for its last words, no bytes
};

/// The daemon itself: its ticks, its notes.
inline constexpr std::uint8_t kRawDaemon = 255;

struct RawRecord {
  std::uint8_t device{0};  ///< Slot::number(), or kRawDaemon
  RawDirection direction{RawDirection::received};
  Stamp at;
  std::string_view bytes;  ///< valid until the decoder is fed again
};

struct RawLogHeader {
  std::string rig;
  std::string run_id;  ///< what the file belongs to; of the daemon's own journal: its name and number
};

inline constexpr std::size_t kRawRecordMax = 1U << 20U;  ///< bytes of payload; longer is refused as damage

[[nodiscard]] std::uint32_t crc32(std::string_view bytes);
[[nodiscard]] std::string encode_header(const RawLogHeader& header);

/// Writes the records of one file, in their order.
class RawLogEncoder {
 public:
  /// Appends to `out`. Bytes beyond kRawRecordMax go into further records of the same stamp.
  void encode(const RawRecord& record, std::string& out);

 private:
  [[nodiscard]] bool is_short(const RawRecord& record) const;

  std::optional<Stamp> last_;
};

/// Eats a log in pieces of any size.
class RawLogDecoder {
 public:
  enum class State { header, records, damaged };

  void feed(std::string_view bytes);
  /// The next whole record; empty: more bytes are needed, or the log is damaged.
  [[nodiscard]] std::optional<RawRecord> next();

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] const RawLogHeader& header() const { return header_; }
  /// Offset in the log up to which everything is good.
  [[nodiscard]] std::uint64_t good_bytes() const { return good_; }
  /// To be asked at the end of the file: nothing to say, a torn tail, or damage, with the offset.
  [[nodiscard]] Result<void> finish() const;

 private:
  [[nodiscard]] bool take_header();
  [[nodiscard]] std::optional<RawRecord> take_record(std::string_view rest);
  [[nodiscard]] std::optional<RawRecord> take_tick(std::string_view rest);
  std::nullopt_t damage(std::string what);

  State state_{State::header};
  RawLogHeader header_;
  std::optional<Stamp> last_;
  std::string buffer_;
  std::size_t at_{0};
  std::uint64_t good_{0};
  std::string damage_;
};

}  // namespace mgtd
