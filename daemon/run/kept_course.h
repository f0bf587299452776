// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string_view>
#include <vector>

#include "proto/error.h"
#include "proto/run_course.h"

/// A KeptCourse holds what a run learnt and its poses do not tell again: how well the tensor was known after
/// so many of them, and what disturbed it. It is kept as a document of the run file, so that a run that
/// another life of the daemon resumes still has it:
///
///   {"accuracy":[{"poses":18,"sd_nT_per_m":[xx,yy,zz,xy,xz,yz],"residual_nT",
///                 "offset_sd_nT","scale_sd","angle_sd_rad","parameter_sd":[..]}, ...],
///    "disturbances":[{"t_ns","pose","change_nT","limit_nT","seen_by","lasted_s","then"}, ...]}
///
/// null in the place of a number: not known.
namespace mgtd::daemon::run {

/// Name of the document.
inline constexpr std::string_view kCourse = "course";

struct KeptCourse {
  std::vector<CourseAccuracy> accuracy{};
  std::vector<CourseDisturbance> disturbances{};
};

[[nodiscard]] nlohmann::json to_json(const KeptCourse& course);
/// An empty text: nothing yet. Refuses what to_json() does not write.
[[nodiscard]] Result<KeptCourse> kept_course_from_json(std::string_view text);

}  // namespace mgtd::daemon::run
