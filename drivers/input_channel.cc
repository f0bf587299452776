// SPDX-License-Identifier: Apache-2.0
#include "drivers/input_channel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace mgtd::drivers {
namespace {

constexpr std::array<std::string_view, 11> kUnitsOfNames{"A", "mA", "V",   "mV", "degC", "K",
                                                         "W", "Pa", "hPa", "nT", "deg"};

bool is_name(std::string_view name) {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
  return !name.empty() && kLetters.find(name.front()) != std::string_view::npos &&
         std::all_of(name.begin(), name.end(), [&](char c) {
           return c == '_' || (c >= '0' && c <= '9') || kLetters.find(c) != std::string_view::npos;
         });
}

}  // namespace

std::optional<int> sensor_of(std::string_view column) {
  constexpr std::string_view kEnd = "_T_degC";
  if (!column.starts_with('s') || !column.ends_with(kEnd) || column.size() <= kEnd.size())
    return std::nullopt;
  const std::string_view digits = column.substr(1, column.size() - 1 - kEnd.size());
  int number = 0;
  const auto [end, wrong] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  const bool is_sensor = wrong == std::errc() && end == digits.data() + digits.size() && digits[0] != '0' &&
                         number >= 1 && number <= kMostSensors;
  return is_sensor ? std::optional(number - 1) : std::nullopt;
}

std::string_view unit_of_name(std::string_view column) {
  const std::size_t end = column.rfind('_');
  if (end == std::string_view::npos || end == 0) return {};
  const auto found = std::find(kUnitsOfNames.begin(), kUnitsOfNames.end(), column.substr(end + 1));
  return found == kUnitsOfNames.end() ? std::string_view() : *found;
}

void check_column(const InputChannel& channel, Settings& settings) {
  if (!is_name(channel.column)) {
    settings.object(
        channel.key,
        fmt::format("'{}' is no column's name: letters, digits and _, a letter first", channel.column));
    return;
  }
  const std::string_view told = unit_of_name(channel.column);
  if (told.empty() || channel.unit.empty() || told == channel.unit) return;
  settings.object(
      channel.key,
      fmt::format("the end of '{}' says {}, the unit is {}; scale the input to {}, or end the name "
                  "in _{}",
                  channel.column, told, channel.unit, told, channel.unit));
}

void report_inputs(std::span<const InputChannel> channels, std::span<const std::optional<double>> readings,
                   Stamp arrival, const std::function<void(DeviceEvent)>& emit) {
  AuxiliaryReading auxiliary{arrival, {}};
  for (const InputChannel& channel : channels) {
    const std::optional<double>& reading = readings[channel.index];
    if (!reading) continue;
    const double value = channel.scale * *reading + channel.offset;
    if (const auto slot = sensor_of(channel.column))
      emit(TemperatureReading{*slot, arrival, value, std::nullopt, std::nullopt});
    else
      auxiliary.values.emplace_back(channel.column, value);
  }
  if (!auxiliary.values.empty()) emit(std::move(auxiliary));
}

}  // namespace mgtd::drivers
