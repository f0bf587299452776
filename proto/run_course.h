// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proto/fit_so_far.h"
#include "proto/tensor.h"
#include "proto/time.h"

/// RunCourse says what a run has gained so far: from where its sensors have seen the field, how well the
/// tensor became known from pose to pose, and what disturbed it. It answers `run.course` on the control
/// socket and GET /run/course of the console:
///
///   {"run_id",
///    "coverage":{"pose":[1,..],"state":["measured","next","planned",..],"direction":[[x,y,z] or null,..],
///                "hole":{"direction":[x,y,z],"radius_deg"} or null,"good"},
///    "accuracy":{"poses":[18,..],"worst_nT_per_m":[..],"xx":[..],..,"yz":[..],"residual_nT":[..],
///                "offset_sd_nT":[..],"scale_sd_ppm":[..],"angle_sd_deg":[..],
///                "parameters":{"name":["s1 theta",..],"unit":["deg",..],"sd":[[..] or null,..]},
///                "wanted_nT_per_m","why",
///                "expected":{"poses","worst_nT_per_m"},"good"},
///    "disturbances":[{"t","pose","change_nT","limit_nT","seen_by","lasted_s","then"}]}
///
/// Directions are unit vectors in the platform frame, to four decimals. `sd` of the parameters has an entry
/// for each of `poses`, to four digits. `good` says what a good one looks like, with the numbers of this run.
/// null: not known.
namespace mgtd {

enum class CourseState : std::uint8_t { planned, next, measured };
[[nodiscard]] std::string_view name(CourseState state);

/// A pose of the plan, and where the field points at it in the platform frame.
struct CoursePose {
  int number{0};
  CourseState state{CourseState::planned};
  std::optional<Eigen::Vector3d> direction_P{};
};

/// The direction that is farthest from all that were measured, and how far it is from the nearest.
struct CourseHole {
  Eigen::Vector3d direction_P{0, 0, 1};
  double radius_rad{0};
};

/// The tensor's standard deviation by a calibration from so many poses.
struct CourseAccuracy {
  int poses{0};
  Gradient tensor_sd_nT_per_m{};  ///< NaN: the array cannot tell the component
  double worst_nT_per_m{0};
  FitSoFar fit{};
};

/// A parameter of a sensor as it is shown.
struct CourseParameter {
  std::string name, unit;  ///< "s3 iz", "nT"; a scale factor has no unit
  double factor{1};        ///< from the unit of FitSoFar to this one
};

/// The field did not stand still at a pose.
struct CourseDisturbance {
  WallTime t{};  ///< when it was seen
  int pose{0};
  double change_nT{0}, limit_nT{0};
  std::string seen_by{};             ///< "array", "scalar", or "level": that of the scalar, from pose to pose
  std::optional<double> lasted_s{};  ///< empty: not over when last seen
  std::string then{};                ///< what the run did
};

struct RunCourse {
  std::string run_id{};  ///< empty: no run since the daemon began
  std::vector<CoursePose> poses{};
  std::optional<CourseHole> hole{};
  std::vector<CourseAccuracy> accuracy{},
      expected{};                             ///< expected: of the plan, with the noise of its first pose
  std::vector<CourseParameter> parameters{};  ///< those of FitSoFar::parameter_sd, in their order
  std::optional<double> wanted_nT_per_m{};
  std::string why_unknown{};  ///< why the poses do not tell the accuracy yet
  std::string good_coverage{}, good_accuracy{};
  std::vector<CourseDisturbance> disturbances{};
};

[[nodiscard]] nlohmann::ordered_json to_json(const RunCourse& course);

/// Leaves the standard errors of the parameters to the last fit: those of 16 sensors after each of a thousand
/// poses are megabytes.
void keep_last_parameters(RunCourse& course);

}  // namespace mgtd
