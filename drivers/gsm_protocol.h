// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "proto/health.h"
#include "proto/time.h"

/// GEM Systems GSM-90 and GSM-19 (base station) are total-field magnetometers that print a line per reading.
/// Source: the MARTAS project (gsm90protocol.py, gsm19protocol.py, gsm90v6init.sh, gsm90v7init.sh) and MagPy
/// (format_gsm19.py).
///
/// Line 115200 Bd 8N1; lines end in CR LF; fields are separated by blanks.
///
///   v6                04-22-2015 142244  48464.53 99    date, time, nT, quality
///   v7, GSM-19 base   115014.0  48484.12 99             time, nT, quality
///   GSM-19 gradient   115014.0  48484.12  0.53          time, nT, nT/m (tells itself by its decimal point)
///   old GSM-19        410356.0  48484.12                time, nT; hours run on across days
///   some              48484.12                          nT
///   header            /Gem Systems GSM-19GWV ...        and menu text after a key
///
/// Quality: two digits, 99 is best. Set-up strings are sent without any ending and answered by menu text.
/// Not verified on hardware: what the two digits of the quality mean.
namespace mgtd::drivers::gsm {

inline constexpr int kDefaultBaud = 115200;
inline constexpr int kBestQuality = 99;

struct GsmReading {
  double f_nT{0};
  std::optional<int> quality;
  std::optional<double> gradient_nT_per_m;
};

/// Header or menu text: no reading and no damage.
struct GsmText {
  bool header{false};  ///< began with '/'
};

using GsmLine = std::variant<GsmReading, GsmText, Reject>;
[[nodiscard]] GsmLine parse_line(std::string_view line);

/// yymmddwHHMMSS, the date the clock menu expects: w = 0 for Sunday .. 6 for Saturday, UTC.
[[nodiscard]] std::string clock_string(WallTime now);

}  // namespace mgtd::drivers::gsm
