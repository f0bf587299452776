// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <stop_token>
#include <vector>

#include "calib/design/experiment_design.h"
#include "daemon/config/config.h"
#include "daemon/plan/run_plan.h"
#include "proto/pose.h"
#include "proto/run_course.h"

/// These functions predict how accurate a run will be after the first n poses of its plan: from their
/// attitudes (experiment_design.h) and the noise of a pose mean, as the first measured pose shows it and the
/// plan's mean dwell makes it,
///
///     noise^2 = mean over the axes of sd^2 / n  x  dwell of that pose / mean dwell of the plan
///
/// with sd of one sample within the dwell and n samples (n_eff where the pose tells it). Nominal sensors,
/// white noise, no effects.
namespace mgtd::daemon::run {

/// Of the whole plan, at the site and with the field that the pose was measured in. Nothing where the pose
/// has no table angles or shows no noise.
[[nodiscard]] std::optional<calib::design::DesignRequest> planned_design(const config::Config& config,
                                                                         const plan::RunPlan& plan,
                                                                         const Pose& measured);

/// After numbers of poses that grow by equal factors, the whole plan last; nothing for those that determine
/// no calibration. For the worker: ends early when it is told to stop.
[[nodiscard]] std::vector<CourseAccuracy> expected_accuracy(calib::design::DesignRequest whole,
                                                            const std::stop_token& stop);

}  // namespace mgtd::daemon::run
