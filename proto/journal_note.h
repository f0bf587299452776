// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "proto/epoch.h"
#include "proto/error.h"
#include "proto/reading.h"

/// Notes in a journal of raw bytes hold what is needed beside the bytes of the wires to make the stream
/// again: one JSON object each. Numbers go through text and back without loss.
namespace mgtd {

/// The first of every journal.
struct LifeNote {
  std::string software;
  std::string config;  ///< the whole text
  std::uint64_t first_seq{0};
  std::optional<Gap> before;  ///< that the stream begins with; its stamp is not kept
};

/// From here on the stream uses this one.
struct CalibrationNote {
  std::string json;  ///< the whole calibration; empty: none
};

/// A calibration run has the table, or no longer.
struct CalibratingNote {
  bool on{false};
};

/// A sensor answers after it did not: its samples are counted anew.
struct ReopenedNote {
  int slot{0};
};

/// What the table was asked for.
struct TableOrder {
  enum class What : std::uint8_t { home, move, stop };
  What what{What::stop};
  TableAngles target;  ///< of move
};

/// Said by a table that has no port.
struct TableNote {
  TableReading reading;
};

/// The disk refused: so many bytes are missing before this.
struct LostNote {
  std::uint64_t bytes{0};
};

using JournalNote =
    std::variant<LifeNote, CalibrationNote, CalibratingNote, ReopenedNote, TableOrder, TableNote, LostNote>;

[[nodiscard]] std::string encode(const JournalNote& note);
/// Refuses what is none of the above; a later version may know more.
[[nodiscard]] Result<JournalNote> parse_note(std::string_view text);

}  // namespace mgtd
