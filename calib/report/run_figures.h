// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "calib/fit/joint/accuracy_so_far.h"
#include "calib/report/figures/figure.h"
#include "calib/report/panel_figures.h"

/// These functions draw figures of the measurement itself: which directions of the field the sensors saw,
/// what happened when, and how the tensor became known.
namespace mgtd::calib::report {

/// Directions of the field in the platform, and the largest hole between them.
[[nodiscard]] figures::Figure coverage_of(const PanelModel& model);

/// One time axis: the residual of the channel that depends most on time, temperatures, up to three extra
/// columns, the scalar reference. Times without a pose that are five times the usual are gaps.
[[nodiscard]] figures::Figure time_figure(const PanelModel& model);

/// Closure at every pose with its chi-square against the noise of a pose mean. Empty for arrays without
/// closure.
[[nodiscard]] std::optional<figures::Figure> closure_figure(const PanelModel& model);

/// Fits of the first poses, more and more of them; `table` in the order of time. The poses of a large table
/// are not fitted again and again: empty above kMostPosesForAccuracy.
inline constexpr std::size_t kMostPosesForAccuracy = 1000;
[[nodiscard]] std::optional<figures::Figure> accuracy_of(const PoseTable& table,
                                                         const fit::FitOptions& options,
                                                         std::optional<double> wanted_nT_per_m);

}  // namespace mgtd::calib::report
