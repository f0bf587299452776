// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "proto/pose.h"

/// RunTime gives the time of a pose since the start of the run that a calibration was fitted to. Where both
/// the run and a pose tell absolute time (t_utc) that counts; else t_s, and the origins of different tables
/// are taken as the same.
namespace mgtd::calib::poses {

struct RunTime {
  std::optional<WallTime> start;

  /// t_utc less t_s of the first pose that has an absolute time.
  [[nodiscard]] static RunTime of(const PoseTable& table);
  /// Zero for a pose without any time.
  [[nodiscard]] double hours(const Pose& pose) const;
};

/// "t_s" for a pose without any time, else empty.
[[nodiscard]] inline std::string_view missing_time(const Pose& pose) {
  return pose.t_s || pose.t_utc ? "" : "t_s";
}

}  // namespace mgtd::calib::poses
