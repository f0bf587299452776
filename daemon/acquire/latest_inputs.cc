// SPDX-License-Identifier: Apache-2.0
#include "daemon/acquire/latest_inputs.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

namespace mgtd::daemon::acquire {

LatestInputs::LatestInputs(std::vector<std::string> columns) {
  for (std::string& column : columns) values_.push_back({.column = std::move(column)});
}

void LatestInputs::push(const AuxiliaryReading& reading) {
  for (const auto& [column, value] : reading.values) {
    covariates_[column] = value;
    set(column, value, reading.arrival.mono);
  }
}

void LatestInputs::push(const TemperatureReading& reading) {
  if (reading.sensor_degC)
    set(fmt::format("s{}_T_degC", reading.slot + 1), *reading.sensor_degC, reading.arrival.mono);
}

void LatestInputs::set(const std::string& column, double value, Instant at) {
  heard_[column] = at;
  for (InputValue& known : values_) {
    if (known.column == column) known.value = value;
  }
}

void LatestInputs::advance(Instant now) {
  const auto old = [&](std::string_view column) {
    const auto at = heard(column);
    return !at || now - *at > kFreshInput;
  };
  std::erase_if(covariates_, [&](const auto& input) { return old(input.first); });
  for (InputValue& known : values_) {
    if (old(known.column)) known.value = std::numeric_limits<double>::quiet_NaN();
  }
}

std::optional<Instant> LatestInputs::heard(std::string_view column) const {
  const auto found = heard_.find(column);
  return found == heard_.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace mgtd::daemon::acquire
