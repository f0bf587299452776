// SPDX-License-Identifier: Apache-2.0
#include "proto/time.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <limits>
#include <optional>

namespace mgtd {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr std::int64_t kSecondsPerDay = 86'400;
/// Nanoseconds in 64 bits reach from 1677-09-22 to 2262-04-11.
constexpr std::int64_t kMostDays = std::numeric_limits<std::int64_t>::max() / kNsPerSecond / kSecondsPerDay;

std::optional<int> digits(std::string_view text, std::size_t at, std::size_t count) {
  int value = 0;
  const char* const first = text.data() + at;
  const auto [stop, error] = std::from_chars(first, first + count, value);
  if (error != std::errc{} || stop != first + count || *first == '-') return std::nullopt;
  return value;
}

}  // namespace

std::string format_utc(WallTime t) {
  std::int64_t seconds = t.ns / kNsPerSecond;
  std::int64_t ns = t.ns % kNsPerSecond;
  if (ns < 0) {
    ns += kNsPerSecond;
    --seconds;
  }
  const auto day =
      std::chrono::floor<std::chrono::days>(std::chrono::sys_seconds{std::chrono::seconds{seconds}});
  const std::chrono::year_month_day date{day};
  const std::int64_t in_day = seconds - day.time_since_epoch().count() * kSecondsPerDay;
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:06}Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), in_day / 3600,
                     in_day / 60 % 60, in_day % 60, ns / 1000);
}

Result<WallTime> parse_utc(std::string_view text) {
  const auto bad = [&] {
    return fail(ErrorCode::bad_input, fmt::format("'{}' is not a UTC time", text),
                "write it as 2026-11-21T10:00:00.123456Z");
  };
  if (text.size() < 20 || text.back() != 'Z' || text[4] != '-' || text[7] != '-' || text[10] != 'T' ||
      text[13] != ':' || text[16] != ':') {
    return bad();
  }
  const auto year = digits(text, 0, 4), month = digits(text, 5, 2), day = digits(text, 8, 2);
  const auto hour = digits(text, 11, 2), minute = digits(text, 14, 2), second = digits(text, 17, 2);
  if (!year || !month || !day || !hour || !minute || !second) return bad();
  const std::chrono::year_month_day date{std::chrono::year{*year},
                                         std::chrono::month{static_cast<unsigned>(*month)},
                                         std::chrono::day{static_cast<unsigned>(*day)}};
  if (!date.ok() || *hour > 23 || *minute > 59 || *second > 60) return bad();
  std::int64_t ns = 0;
  const std::string_view fraction = text.substr(19, text.size() - 20);
  if (!fraction.empty()) {
    if (fraction[0] != '.' || fraction.size() < 2 || fraction.size() > 10) return bad();
    const auto value = digits(fraction, 1, fraction.size() - 1);
    if (!value) return bad();
    ns = *value;
    for (std::size_t i = fraction.size() - 1; i < 9; ++i) ns *= 10;
  }
  const std::int64_t days = std::chrono::sys_days{date}.time_since_epoch().count();
  if (std::abs(days) >= kMostDays) return bad();
  return WallTime{(days * kSecondsPerDay + *hour * 3600 + *minute * 60 + *second) * kNsPerSecond + ns};
}

}  // namespace mgtd
