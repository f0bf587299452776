// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/device.h"
#include "proto/error.h"
#include "proto/reading.h"

/// A RunPlan lists the poses of a calibration run in the order in which they are measured.
///
/// Standard set: a turn about platform Z with pitch and roll at zero, one way in steps of 2 x step_deg, then
/// the poses between on the way back, so that every other azimuth was approached in the other sense at
/// another time. Random set: attitudes uniform over the rotations b_P = Rz(azimuth) Ry(pitch) Rx(roll) b_S
/// that lie within the table's limits (Haar measure: azimuth and roll uniform, density |cos pitch| of the
/// pitch), some of them revisits of an earlier attitude at a random later time; dwell length and the sense in
/// which the azimuth arrives are mixed at random, so that revisits come from the same side and from the
/// other.
///
/// The same options and seed give the same plan with every compiler and library. Angles are multiples of
/// 0.01 degree (a limit that is not one is kept off by less than that).
namespace mgtd::daemon::plan {

/// Planned angles are multiples of 0.01 deg: k / 100 is read back bit for bit.
inline constexpr double kPerDegree = 100;

struct PlanOptions {
  double step_deg{10};  ///< divides 360 into an even number of poses; 0: no standard set
  int random{121};      ///< poses of the random set, revisits included
  int revisits{24};
  double dwell_short_s{4};  ///< also that of the standard set
  double dwell_long_s{8};
  std::uint64_t seed{1};
  /// Ways to mount the array on the table by hand (mounting.h), for a table of one axis; see mount_plan.h.
  std::vector<TableAngles> mounts{};
  bool by_hand{false};  ///< the table itself is turned by hand
  std::string list{};   ///< name of the list that the poses are from (plan_from_list.h); empty: made here
  bool operator==(const PlanOptions&) const = default;
};

struct PlannedPose {
  int number{0};    ///< from 1, in the order of measurement
  std::string set;  ///< "standard" or "random"
  TableAngles target;
  double dwell_s{0};
  int sense{0};                     ///< of the azimuth's approach: +1 or -1; 0 either
  std::optional<int> mount{};       ///< counts the mountings of the array from 1
  TableAngles mounting{};           ///< of it on the table, where `mount` is set
  std::optional<int> revisit_of{};  ///< number of the earlier pose
  /// From the stop to the middle of the dwell, at least; empty: as soon as it has settled.
  std::optional<double> since_stop_s{};
  std::string note{};  ///< what a hand has to do before it
  bool operator==(const PlannedPose&) const = default;
};

struct RunPlan {
  PlanOptions options;
  std::vector<PlannedPose> poses;
  std::vector<std::string> notes;  ///< what the table's limits cost, in words for the operator
  bool operator==(const RunPlan&) const = default;
};

/// Refuses options that make no plan. A table whose limits leave little to choose from still gets one; the
/// notes say what a calibration will lack.
[[nodiscard]] Result<RunPlan> make_plan(const PlanOptions& options, const drivers::TableLimits& limits);

}  // namespace mgtd::daemon::plan
