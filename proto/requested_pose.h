// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "proto/error.h"
#include "proto/reading.h"

/// A RequestedPose is one pose of a list to be measured, as a client of the control socket asks for it:
///
///   {"pose":1,"azimuth_deg":..,"pitch_deg":..,"roll_deg":..,"set":"random","sense":1,"dwell_s":4,
///    "since_stop_s":5,"note":"..","line":2}
///
/// `pose` and the three angles are needed. `since_stop_s`: from the stop of the table to the middle of the
/// dwell, where the pose is to be measured later than it could be. `note`: what a hand has to do before it;
/// the run asks for that. `line`: where it stands in its file.
namespace mgtd {

struct RequestedPose {
  int number{0};
  TableAngles angles{};
  std::string set{"random"};
  std::optional<int> sense{};
  std::optional<double> dwell_s{}, since_stop_s{};
  std::string note{};
  int line{0};
};
[[nodiscard]] bool operator==(const RequestedPose& a, const RequestedPose& b);

[[nodiscard]] nlohmann::json to_json(const RequestedPose& pose);
/// Refuses what is missing, unknown, of another type or outside its limits, by name.
[[nodiscard]] Result<RequestedPose> requested_pose_from_json(const nlohmann::json& object);

}  // namespace mgtd
