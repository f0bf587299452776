// SPDX-License-Identifier: Apache-2.0
#include "proto/magnet_status.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace mgtd {
namespace {

std::size_t arms_with(const MagnetStatus& status, int sensor) {
  return static_cast<std::size_t>(
      std::count(status.sensor_on_arm.begin(), status.sensor_on_arm.end(), std::optional(sensor)));
}

}  // namespace

std::optional<bool> all_right(const MagnetStatus& status) {
  for (const auto& sensor : status.sensor_on_arm) {
    if (!sensor || arms_with(status, *sensor) > 1) return std::nullopt;
  }
  for (std::size_t arm = 0; arm < status.sensor_on_arm.size(); ++arm) {
    if (*status.sensor_on_arm[arm] != static_cast<int>(arm) + 1) return false;
  }
  return true;
}

std::vector<std::string> findings(const MagnetStatus& status) {
  std::vector<std::string> out;
  if (!status.end) return out;
  const std::string_view on = status.noun == "arm" ? "on" : "at";
  for (std::size_t i = 0; i < status.sensor_on_arm.size(); ++i) {
    const int arm = static_cast<int>(i) + 1;
    const auto& sensor = status.sensor_on_arm[i];
    if (!sensor) {
      out.push_back(fmt::format("{} {} was not {} for: what is {} it is open", status.noun, arm,
                                arm > status.asked ? "asked" : "answered", on));
    } else if (arms_with(status, *sensor) > 1) {
      out.push_back(
          fmt::format("the cable labelled s{} answered for {} {} and for another one: do the test again",
                      *sensor, status.noun, arm));
    } else if (*sensor != arm) {
      out.push_back(fmt::format("the cable labelled s{} is {} {} {}", *sensor, on, status.noun, arm));
    }
  }
  return out;
}

nlohmann::ordered_json to_json(const MagnetStatus& status) {
  auto arms = nlohmann::ordered_json::array();
  for (const auto& sensor : status.sensor_on_arm)
    arms.push_back(sensor ? nlohmann::ordered_json(*sensor) : nlohmann::ordered_json(nullptr));
  const auto right = all_right(status);
  return {{"active", !status.end.has_value()},
          {"state", status.state},
          {"arm", status.arm ? nlohmann::ordered_json(*status.arm) : nlohmann::ordered_json(nullptr)},
          {"text", status.text},
          {"sensor_on_arm", std::move(arms)},
          {"right", right && status.end ? nlohmann::ordered_json(*right) : nlohmann::ordered_json(nullptr)},
          {"findings", findings(status)}};
}

}  // namespace mgtd
