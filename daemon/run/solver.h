// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <stop_token>
#include <string>

#include "calib/fit/method_choice/fit.h"
#include "daemon/store/pose_source.h"
#include "daemon/store/run_header.h"

/// The daemon and the offline tool both call the fit through these functions: the same options from the same
/// run file give the same answer.
namespace mgtd::daemon::run {

/// The options a run file states; the rest as the fit's defaults.
[[nodiscard]] calib::fit::FitOptions fit_options(const store::RunOptions& options);

/// The same with the model that is kept in the file. Refuses an effect that this version does not know.
[[nodiscard]] Result<calib::fit::FitOptions> fit_options(const store::PoseSource& source);

/// Reads the poses of a run file and fits them. Takes what it needs from the file alone, so it may run on any
/// thread, and ends soon after it is told to stop.
[[nodiscard]] Result<calib::fit::FitReport> solve_run(const std::filesystem::path& run_file,
                                                      std::stop_token stop = {});

}  // namespace mgtd::daemon::run
