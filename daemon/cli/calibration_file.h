// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/calibration/calibration.h"
#include "daemon/cli/fit_flags.h"

namespace mgtd::daemon::cli {

/// This reads a CAL.json. Refusals name the file.
[[nodiscard]] Result<calib::calibration::Calibration> read_calibration(const std::string& path);

/// A CAL.json as it is, or a run fitted with these flags; told apart by content.
[[nodiscard]] Result<calib::calibration::Calibration> calibration_of(const std::string& path,
                                                                     const FitFlags& flags);

}  // namespace mgtd::daemon::cli
