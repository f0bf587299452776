// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "proto/error.h"
#include "proto/health.h"

/// The Mingeo ObsDAQ is a 24-bit digitiser with three simultaneous channels, for fluxgates with analogue
/// output; the PalmAcq GPS time-stamper may stand in front of it. Source: the MARTAS project
/// (martas/lib/obsdaqprotocol.py, martas/app/{obsdaq,palmacq}.py and its captured dialogues), which cites the
/// maker's tables.
///
/// Line 8N1, 19200 Bd after power-on (57600 Bd to a PalmAcq). ASCII, every command and reply ends in one CR,
/// no checksum. AA = address, two hex digits (factory 01).
///
///   host                reply          meaning
///   ||||... (30)        -              quick stop, repeated until silent
///   #AAST               -              stop, idle
///   $AAM                !AA<name>      identity, e.g. !01<obsDAQ V5.5.7>
///   $AASN               !AA..SN<serial>  serial number
///   $AAnWS0201ccdd      !AA0201ccdd    channel n = 0..2: range cc, data rate dd
///   #AAPPeeeeffff       !AAeeeeffff    internal trigger: period, low time, in 64/9.8304 MHz = 6.5104 us
///   #AAPP00000000       !AA00000000    trigger off; needed before configuring, then wait 1 s
///   #AACS               !AA            start acquisition
///   -                   ?AA            refused
///
///   data line           *xxxxxxyyyyyyzzzzzzt                      21 bytes with CR
///   once a second       *xxxxxxyyyyyyzzzzzzt:vvvvttttppppqqqqrrrr 42 bytes with CR
///   behind PalmAcq      :R,00,YYMMDD.hhmmss.sss, in front         24 bytes more
///   xxxxxx  two's complement, volts = n 2^-23 range         t     trigger flag, a letter
///   vvvv    supply = n 2.6622e-3 + 9.15 V                   tttt  electronics = n/128 degC, signed
///   pppp qqqq rrrr  auxiliary inputs = n/8000 V, signed
///
///   PalmAcq (CR): 00 1B then SM:CMD  leave transparent mode;  SF:-  stop forwarding;  SP:R:19200,8,n,1,1 and
///   ST:R  the inner port;  SM:TRP -> AM:TRP,001B  transparent;  SF:R  forward with time stamps.
///
/// Not verified on hardware: whether the period counts from 0 or 1 (the maker's table prints N-1, the
/// captured dialogues N; N is sent); the form of a refusal; replies of the PalmAcq other than AM:TRP are not
/// relied on.
namespace mgtd::drivers::obsdaq {

inline constexpr int kDirectBaud = 19200;
inline constexpr int kPalmAcqBaud = 57600;
inline constexpr std::size_t kLineBytes = 21;
inline constexpr std::size_t kSupplementBytes = 21;
inline constexpr std::size_t kPrefixBytes = 24;
inline constexpr double kTicksPerSecond = 9.8304e6 / 64.0;  ///< unit of eeee and ffff
/// A count this close to the end of the 24 bits (0.1 %) is no measurement.
inline constexpr std::int32_t kNearFullScale = 8'380'000;

struct Range {
  std::string_view code;
  double volts;
};
inline constexpr std::array<Range, 3> kRanges{{{"02", 10.0}, {"03", 5.0}, {"04", 2.5}}};

inline constexpr std::size_t kInputs = 3;               ///< auxiliary: p, q, r
inline constexpr double kInputEnd_V = 32'767 / 8000.0;  ///< an input that says so or more is at its end

/// How the internal trigger is set for a sample rate.
struct Timing {
  std::uint16_t period{0};     ///< eeee
  std::uint16_t low{0};        ///< ffff
  std::string_view rate_code;  ///< dd
  [[nodiscard]] double rate_hz() const { return kTicksPerSecond / period; }
};
/// The slowest (quietest) converter rate whose conversion fits into the period. Refused outside 2.35 to 450
/// Hz.
[[nodiscard]] Result<Timing> timing_for(double rate_hz);

/// The highest sample rate whose lines of `line_bytes`, the supplement once a second included, fit the line.
[[nodiscard]] double highest_rate_hz(int baud, std::size_t line_bytes);

/// A command of the table above with its exact reply.
struct Exchange {
  std::string command;
  std::string reply;
};
[[nodiscard]] std::string quick_stop();
[[nodiscard]] std::string stop(std::string_view address);
[[nodiscard]] std::string identify(std::string_view address);
[[nodiscard]] std::string serial_number(std::string_view address);
[[nodiscard]] Exchange trigger(std::string_view address, std::uint16_t period, std::uint16_t low);
[[nodiscard]] Exchange configure(std::string_view address, int channel, std::string_view range_code,
                                 std::string_view rate_code);
[[nodiscard]] Exchange start(std::string_view address);
[[nodiscard]] Exchange connect_through();  ///< of a PalmAcq

struct Supplement {
  double supply_V{0};
  double electronics_degC{0};
  std::array<double, kInputs> aux_V{};  ///< p, q, r
};

struct Sample {
  std::array<std::int32_t, 3> counts{};
  char trigger{'L'};
  std::optional<Supplement> supplement;
  bool time_stamped{false};  ///< a PalmAcq prefix stood in front
  /// Seconds since 2000-01-01 of the PalmAcq's clock. Empty without a prefix, and when the prefix holds a
  /// date or time that does not exist (the receiver has been seen to send day 32): nothing is guessed from
  /// it.
  std::optional<double> device_time_s;

  [[nodiscard]] bool saturated() const;
};

/// A data line of either form; anything else is refused with the reason to count it under.
[[nodiscard]] tl::expected<Sample, Reject> parse_data_line(std::string_view line);

[[nodiscard]] constexpr double volts(std::int32_t count, double range_V) {
  return static_cast<double>(count) * range_V / 8'388'608.0;
}

}  // namespace mgtd::drivers::obsdaq
