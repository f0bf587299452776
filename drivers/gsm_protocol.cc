// SPDX-License-Identifier: Apache-2.0
#include "drivers/gsm_protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "proto/number.h"

namespace mgtd::drivers::gsm {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool all_digits(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_digit);
}
bool has_point(std::string_view text) { return text.find('.') != std::string_view::npos; }

std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> out;
  while (true) {
    const std::size_t from = line.find_first_not_of(" \t");
    if (from == std::string_view::npos) return out;
    line.remove_prefix(from);
    const std::size_t size = std::min(line.find_first_of(" \t"), line.size());
    out.push_back(line.substr(0, size));
    line.remove_prefix(size);
  }
}

/// MM-DD-YYYY
bool is_date(std::string_view word) {
  return word.size() == 10 && word[2] == '-' && word[5] == '-' && all_digits(word.substr(0, 2)) &&
         all_digits(word.substr(3, 2)) && all_digits(word.substr(6));
}

/// HHMMSS or HHMMSS.f; hours may exceed 23 (old firmware) and leading zeros may be missing.
bool is_time(std::string_view word) {
  const std::string_view whole = word.substr(0, word.find('.'));
  if (!all_digits(whole) || whole.size() > 7 || !parse_number(word)) return false;
  const std::int64_t hhmmss = *parse_integer(whole);
  return hhmmss % 100 < 60 && hhmmss / 100 % 100 < 60;
}

/// nT with decimals: 48484.12
std::optional<double> field_nT(std::string_view word) {
  const std::size_t point = word.find('.');
  if (point == std::string_view::npos || point < 4 || point > 6 || !all_digits(word.substr(0, point)) ||
      !all_digits(word.substr(point + 1)))
    return std::nullopt;
  return parse_number(word);
}

bool is_quality(std::string_view word) { return word.size() <= 2 && all_digits(word); }

}  // namespace

GsmLine parse_line(std::string_view line) {
  if (line.starts_with('/')) return GsmText{true};
  std::vector<std::string_view> word = words(line);
  if (word.empty() || std::any_of(line.begin(), line.end(), is_letter)) return GsmText{};
  if (is_date(word.front())) word.erase(word.begin());
  GsmReading reading;
  if (word.size() > 1 && is_quality(word.back())) {
    reading.quality = static_cast<int>(*parse_integer(word.back()));
    word.pop_back();
  } else if (word.size() == 3 && has_point(word.back())) {
    reading.gradient_nT_per_m = parse_number(word.back());
    if (!reading.gradient_nT_per_m) return Reject::number;
    word.pop_back();
  }
  if (word.empty() || word.size() > 2) return Reject::length;
  if (word.size() == 2 && !is_time(word.front())) return Reject::number;
  const std::optional<double> f_nT = field_nT(word.back());
  if (!f_nT) return Reject::number;
  reading.f_nT = *f_nT;
  return reading;
}

std::string clock_string(WallTime now) {
  namespace chr = std::chrono;
  const chr::sys_time<chr::seconds> at{chr::floor<chr::seconds>(chr::nanoseconds(now.ns))};
  const auto day = chr::floor<chr::days>(at);
  const chr::year_month_day date{day};
  const chr::hh_mm_ss<chr::seconds> time{at - day};
  return fmt::format("{:02}{:02}{:02}{}{:02}{:02}{:02}", static_cast<int>(date.year()) % 100,
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                     chr::weekday(day).c_encoding(), time.hours().count(), time.minutes().count(),
                     time.seconds().count());
}

}  // namespace mgtd::drivers::gsm
