// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calib/sensor/sensor_model.h"
#include "proto/pose.h"

/// A LawAction is what could be measured after a run to tell formulas apart: it sets the conditions under
/// which further poses are measured. It changes poses as candidate_poses.h makes them.
namespace mgtd::calib::design {

inline constexpr std::size_t kLawPoses = 24;  ///< that an action adds

/// Where in an action a pose stands.
struct ActionMoment {
  std::size_t k{0};  ///< number of the pose, 0 .. kLawPoses - 1
  double share{0};   ///< of the time of the action, 0 .. 1
};

struct LawAction {
  std::string_view text;
  double extra_min{0};
  bool by_the_rig{false};  ///< attitudes, approach and dwells are all it takes
  /// Attitudes and approach are chosen for what they tell; else the run's own are repeated.
  bool placed{true};
  double wider_rad{0};  ///< attitudes may tilt so much beyond those of the run
  bool other_day{false};
  bool dwells{false};  ///< of many lengths
  /// Why the columns of a run cannot express it; null or empty: they can.
  std::optional<std::string> (*lacks)(const PoseTable& run){nullptr};
  void (*change)(Pose& pose, const ActionMoment& at, const PerSensor<sensor::SensorModel>& sensors){nullptr};
};

/// "24 more poses as before" is the first.
[[nodiscard]] std::span<const LawAction> law_actions();

/// The table turned the array, and nobody else: attitudes other than those of the run can be asked for.
[[nodiscard]] bool turnable(const PoseTable& run);

/// A table was there, and told an angle: without one nobody but a hand repeats an attitude.
[[nodiscard]] bool has_table(const PoseTable& run);

/// Of one angle over a run that has it at every pose.
struct AngleRange {
  double least_rad{0}, most_rad{0};
};
[[nodiscard]] AngleRange angle_range(const PoseTable& run, const std::optional<double> Pose::*angle);

}  // namespace mgtd::calib::design
