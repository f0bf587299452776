// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "daemon/plan/run_plan.h"

/// The duration of a plan is the sum over its poses: the longest travel of an axis at the table's speed,
/// settling, dwell.
namespace mgtd::daemon::plan {

struct Pace {
  double velocity_rad_per_s{0.17};  ///< of every axis; they move together
  double per_move_s{1.0};           ///< acceleration, commands, answers
  double settle_s{2.0};
  double home_s{20.0};
  double solve_s{1.0};
  double by_hand_s{40};  ///< to set three scales and read them
  double mount_s{180};   ///< to mount the array in another way
};

[[nodiscard]] double move_s(const Pace& pace, const TableAngles& from, const TableAngles& to);
/// Move, settle and dwell of the pose at `index`, coming from the one before it (the first: from zero
/// angles), by way of an overshoot where the azimuth has to arrive in the other sense.
[[nodiscard]] double pose_s(const Pace& pace, const RunPlan& plan, std::size_t index);
/// From the reference move to the checks of the calibration.
[[nodiscard]] double total_s(const Pace& pace, const RunPlan& plan);

/// "157 poses: 36 standard, 121 random (24 of them revisits) ..." and the notes, one per line.
[[nodiscard]] std::string describe(const RunPlan& plan, const Pace& pace);

}  // namespace mgtd::daemon::plan
