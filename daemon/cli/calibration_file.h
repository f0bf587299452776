// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/calibration/calibration.h"
#include "daemon/cli/fit_flags.h"
#include "daemon/store/same_array.h"

namespace mgtd::daemon::cli {

/// read_calibration() reads a CAL.json. Refusals name the file.
[[nodiscard]] Result<calib::calibration::Calibration> read_calibration(const std::string& path);

/// A CAL.json as it is, or a run fitted with these flags; told apart by content.
[[nodiscard]] Result<calib::calibration::Calibration> calibration_of(const std::string& path,
                                                                     const FitFlags& flags);

/// The same with the places that the first of `files` knows, for those that are pose tables, which know none.
[[nodiscard]] Result<FitFlags> with_places_of(const std::vector<std::string>& files, FitFlags flags);

/// Refuses a calibration (of `file`) of another array than the one that was read: of more or fewer sensors,
/// or of places that are not those of the run file.
[[nodiscard]] Result<void> same_array(const calib::calibration::Calibration& calibration,
                                      const std::string& file, const store::PoseSource& source);

/// Refuses a calibration (of `file`) that does not continue the history of an array: one without a date, or
/// of another array than the first.
[[nodiscard]] Result<void> continues(const store::PlacedFile& first,
                                     const calib::calibration::Calibration& calibration,
                                     const std::string& file);

}  // namespace mgtd::daemon::cli
