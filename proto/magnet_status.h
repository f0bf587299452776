// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "proto/per_sensor.h"

/// MagnetStatus says how far the magnet test is, and what it found.
///
///   {"active","state":"resting|waiting|leaving|done|timed out|stopped","arm":1 or null,"text",
///    "sensor_on_arm":[1,4,3,2] (null: open),"right": true, false or null (open),"findings":["..."]}
namespace mgtd {

enum class MagnetEnd { done, timed_out, stopped };

struct MagnetStatus {
  std::string state;
  std::optional<int> arm;                       ///< asked for
  std::string text;                             ///< what to do, or how it ended
  std::string noun{"arm"};                      ///< "place" where the array is no cross
  PerSensor<std::optional<int>> sensor_on_arm;  ///< both from 1
  int asked{0};                                 ///< arms the operator was asked for, from the first
  std::optional<MagnetEnd> end;
};

/// What is on another arm than its label says, and what stays open, in sentences.
[[nodiscard]] std::vector<std::string> findings(const MagnetStatus& status);
/// Every sensor is on its arm; nothing when that is open.
[[nodiscard]] std::optional<bool> all_right(const MagnetStatus& status);

[[nodiscard]] nlohmann::ordered_json to_json(const MagnetStatus& status);

}  // namespace mgtd
