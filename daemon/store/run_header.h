// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "calib/sensor/geometry.h"
#include "proto/reading.h"
#include "proto/time.h"

/// The header of a run file is written before the first pose and never changed afterwards.
namespace mgtd::daemon::store {

/// What a later fit of the same file must know to give the same answer. Empty: not stated.
struct RunOptions {
  calib::sensor::Geometry geometry;             ///< also tells how many sensors a pose has
  std::optional<double> field_nT, field_sd_nT;  ///< of the site, when no scalar reference is in the poses
  std::optional<double> inclination_rad, declination_rad;
  std::optional<double> table_sd_rad;
  std::optional<double> until_tensor_sd_nT_per_m;  ///< at which the run was to end; a resumed one still does
  std::optional<double> until_explained_min;       ///< that it may go on after its plan
  std::optional<int> retries;                      ///< of one pose, where the configuration's are not meant
  PerSensor<std::string> sensor_names{"s1", "s2", "s3", "s4"};  ///< as many as the geometry has places
};

/// s1, s2, ...
[[nodiscard]] PerSensor<std::string> numbered_sensors(std::size_t sensors);

struct RunHeader {
  std::string run_id;       ///< made by the caller; also the stem of the file's name
  std::uint64_t number{0};  ///< of the runs of one folder (run_files.h); 0: none
  std::string rig;
  WallTime started_utc;  ///< origin of t_s
  std::string software;  ///< "mgtd 0.1.0"
  std::string config;    ///< text of the configuration as read; empty for an import
  std::string plan;      ///< JSON
  std::uint64_t seed{0};
  std::string source;  ///< "measured", or the file it was imported from
  RunOptions options;
};

}  // namespace mgtd::daemon::store
