// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "proto/reading.h"
#include "proto/time.h"

/// A Pose is one row of the pose table: the dwell means of everything measured while the table stood still.
/// Angles are radians here and degrees in the file. What was not measured is empty, never zero.
namespace mgtd {

struct Pose {
  int number{0};
  std::string set;            ///< "standard" (used by step 2), "random", "check" (never fitted), or any word
  std::optional<double> t_s;  ///< middle of the dwell since the run's start
  std::optional<WallTime> t_utc;
  std::optional<double> azimuth_rad, pitch_rad, roll_rad;
  std::optional<double> f_nT, f_sd_nT;
  /// The field itself, measured beside the sensors or made by a coil cage, and the standard uncertainty of
  /// each component. In the frame that the table turns; without table angles in one fixed to the platform.
  std::optional<Eigen::Vector3d> ref_nT;
  std::optional<double> ref_sd_nT;
  std::optional<double> n, n_eff;
  PerSensor<Eigen::Vector3d> y_nT{no_readings()};           ///< raw mean reading, nT at nominal scale
  PerSensor<std::array<std::optional<double>, 3>> sd_nT{};  ///< of one sample within the dwell
  std::optional<int> mount, sense;
  std::optional<double> dwell_s, since_stop_s;
  PerSensor<std::optional<double>> T_degC{};
  std::map<std::string, double> covariates;  ///< every other numeric column, under its own name

  /// All three table angles are known.
  [[nodiscard]] std::optional<TableAngles> angles() const {
    if (!azimuth_rad || !pitch_rad || !roll_rad) return std::nullopt;
    return TableAngles{*azimuth_rad, *pitch_rad, *roll_rad};
  }
};

/// Where the table was while it moved.
struct PathPoint {
  double t_s{0};  ///< as Pose::t_s
  TableAngles angles;
};

/// Poses in the order they were measured. Numbers are unique (the reader refuses others).
struct PoseTable {
  std::vector<Pose> poses;
  std::string source;             ///< file name for messages; empty when made in memory
  std::vector<PathPoint> path{};  ///< in order of time; empty where only the dwells are known
};

inline constexpr double kDefaultScalarSd_nT = 0.05;  ///< of f_nT when no f_sd_nT stands beside it

}  // namespace mgtd
