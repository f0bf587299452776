// SPDX-License-Identifier: Apache-2.0
#include "drivers/obsdaq_protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>

namespace mgtd::drivers::obsdaq {
namespace {

struct DataRate {
  std::string_view code;
  double hz;
};
constexpr std::array<DataRate, 11> kDataRates{{{"03", 3.2},
                                               {"13", 6.4},
                                               {"23", 12.8},
                                               {"33", 19.2},
                                               {"43", 32.0},
                                               {"53", 38.4},
                                               {"63", 64.0},
                                               {"72", 76.8},
                                               {"82", 128.0},
                                               {"92", 640.0},
                                               {"A1", 1280.0}}};

/// Time beyond one conversion for which the trigger must be high: 0.326 ms in every row of the maker's table.
constexpr double kTriggerMargin = 50.0;
/// Least low time, 1.1 ms: every row of that table keeps it.
constexpr double kLeastLow = 169.0;

std::optional<std::uint32_t> hex(std::string_view digits) {
  std::uint32_t value = 0;
  for (const char c : digits) {
    std::uint32_t digit = 0;
    if (c >= '0' && c <= '9') {
      digit = static_cast<std::uint32_t>(c - '0');
    } else if (c >= 'A' && c <= 'F') {
      digit = static_cast<std::uint32_t>(c - 'A') + 10;
    } else {
      return std::nullopt;
    }
    value = value * 16 + digit;
  }
  return value;
}

std::optional<std::int32_t> signed_hex(std::string_view digits) {
  const std::optional<std::uint32_t> raw = hex(digits);
  if (!raw) return std::nullopt;
  const auto bits = static_cast<unsigned>(digits.size() * 4);
  const std::int64_t value = *raw;
  return static_cast<std::int32_t>(
      value >= (std::int64_t{1} << (bits - 1)) ? value - (std::int64_t{1} << bits) : value);
}

std::optional<int> decimal(std::string_view digits) {
  int value = 0;
  for (const char c : digits) {
    if (c < '0' || c > '9') return std::nullopt;
    value = value * 10 + (c - '0');
  }
  return value;
}

tl::expected<Supplement, Reject> parse_supplement(std::string_view text) {
  std::array<std::int32_t, 5> n{};
  for (std::size_t i = 0; i < n.size(); ++i) {
    const auto value = signed_hex(text.substr(4 * i, 4));
    if (!value) return tl::unexpected(Reject::number);
    n[i] = *value;
  }
  return Supplement{n[0] * 2.6622e-3 + 9.15, n[1] / 128.0, {n[2] / 8000.0, n[3] / 8000.0, n[4] / 8000.0}};
}

/// "YYMMDD.hhmmss.sss" -> seconds since 2000-01-01. Outer empty: not of this form. Inner empty: no such time.
std::optional<std::optional<double>> parse_gps_time(std::string_view text) {
  if (text.size() != 17 || text[6] != '.' || text[13] != '.') return std::nullopt;
  std::array<int, 7> field{};
  constexpr std::array<std::size_t, 7> kStart{0, 2, 4, 7, 9, 11, 14};
  for (std::size_t i = 0; i < field.size(); ++i) {
    const auto value = decimal(text.substr(kStart[i], i == 6 ? 3 : 2));
    if (!value) return std::nullopt;
    field[i] = *value;
  }
  namespace chr = std::chrono;
  const chr::year_month_day date{chr::year(2000 + field[0]), chr::month(static_cast<unsigned>(field[1])),
                                 chr::day(static_cast<unsigned>(field[2]))};
  if (!date.ok() || field[3] > 23 || field[4] > 59 || field[5] > 59) return std::optional<double>();
  constexpr chr::sys_days kOrigin{chr::year(2000) / 1 / 1};
  const auto days = (chr::sys_days(date) - kOrigin).count();
  return static_cast<double>(days) * 86400.0 + field[3] * 3600.0 + field[4] * 60.0 + field[5] +
         field[6] * 1e-3;
}

}  // namespace

Result<Timing> timing_for(double rate_hz) {
  const double period = std::round(kTicksPerSecond / rate_hz);
  if (!(rate_hz > 0) || period > 0xFFFF) {
    return fail(ErrorCode::bad_input,
                fmt::format("{} Hz is slower than the trigger counts; the slowest is 2.35 Hz", rate_hz));
  }
  for (const DataRate& converter : kDataRates) {
    const double high = std::ceil(kTicksPerSecond / converter.hz) + kTriggerMargin;
    if (converter.hz < rate_hz || high + kLeastLow > period) continue;
    return Timing{static_cast<std::uint16_t>(period), static_cast<std::uint16_t>(period - high),
                  converter.code};
  }
  return fail(ErrorCode::bad_input,
              fmt::format("{} Hz is faster than the converter; the fastest is 450 Hz", rate_hz));
}

double highest_rate_hz(int baud, std::size_t line_bytes) {
  return (baud / 10.0 - static_cast<double>(kSupplementBytes)) / static_cast<double>(line_bytes);
}

std::string quick_stop() { return std::string(30, '|'); }
std::string stop(std::string_view address) { return fmt::format("#{}ST\r", address); }
std::string identify(std::string_view address) { return fmt::format("${}M\r", address); }
std::string serial_number(std::string_view address) { return fmt::format("${}SN\r", address); }

Exchange trigger(std::string_view address, std::uint16_t period, std::uint16_t low) {
  return {fmt::format("#{}PP{:04X}{:04X}\r", address, period, low),
          fmt::format("!{}{:04X}{:04X}", address, period, low)};
}

Exchange configure(std::string_view address, int channel, std::string_view range_code,
                   std::string_view rate_code) {
  return {fmt::format("${}{}WS0201{}{}\r", address, channel, range_code, rate_code),
          fmt::format("!{}0201{}{}", address, range_code, rate_code)};
}

Exchange start(std::string_view address) {
  return {fmt::format("#{}CS\r", address), fmt::format("!{}", address)};
}

Exchange connect_through() { return {"SM:TRP\r", "AM:TRP,001B"}; }

bool Sample::saturated() const {
  return std::any_of(counts.begin(), counts.end(),
                     [](std::int32_t n) { return std::abs(n) >= kNearFullScale; });
}

tl::expected<Sample, Reject> parse_data_line(std::string_view line) {
  Sample sample;
  if (line.starts_with(':')) {
    if (line.size() < kPrefixBytes || !line.starts_with(":R,") || line[5] != ',' || line[23] != ',')
      return tl::unexpected(Reject::framing);
    const auto time = parse_gps_time(line.substr(6, 17));
    if (!time || !decimal(line.substr(3, 2))) return tl::unexpected(Reject::number);
    sample.time_stamped = true;
    sample.device_time_s = *time;
    line.remove_prefix(kPrefixBytes);
  }
  if (!line.starts_with('*')) return tl::unexpected(Reject::framing);
  if (line.size() != 20 && line.size() != 41) return tl::unexpected(Reject::length);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto count = signed_hex(line.substr(1 + 6 * axis, 6));
    if (!count) return tl::unexpected(Reject::number);
    sample.counts[axis] = *count;
  }
  sample.trigger = line[19];
  if (sample.trigger < 'A' || sample.trigger > 'Z') return tl::unexpected(Reject::framing);
  if (line.size() == 41) {
    if (line[20] != ':') return tl::unexpected(Reject::framing);
    const auto supplement = parse_supplement(line.substr(21));
    if (!supplement) return tl::unexpected(supplement.error());
    sample.supplement = *supplement;
  }
  return sample;
}

}  // namespace mgtd::drivers::obsdaq
