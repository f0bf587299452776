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

/// Refuses a calibration (of `file`) of more or fewer sensors than the table has readings of.
[[nodiscard]] Result<void> same_sensors(const calib::calibration::Calibration& calibration,
                                        const std::string& file, const PoseTable& table);

}  // namespace mgtd::daemon::cli
