// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "calib/calibration/calibration.h"
#include "calib/fit/method_choice/fit.h"
#include "daemon/store/run_file.h"
#include "proto/instrument_identity.h"

/// A calibration holds for the instruments that its run was measured with; they are kept as checks, one for
/// each: "instrument.s2", measured "obsDAQ V5.5.7, serial 1002". So they stand in the run file (stage
/// "instruments") and among the calibration's checks, are part of its id, and are read by every version.
namespace mgtd::daemon::acquire {

inline constexpr const char* kInstrumentsStage = "instruments";

[[nodiscard]] std::vector<Check> to_checks(const std::vector<InstrumentIdentity>& instruments);
/// Those among the checks; other checks are passed over.
[[nodiscard]] std::vector<InstrumentIdentity> instruments_among(const std::vector<Check>& checks);

/// Adds those that the run file knows to the calibration's checks and seals it again. A pose table in CSV
/// knows none, nor does a run that was measured before they were kept: then nothing changes.
void name_instruments(calib::calibration::Calibration& calibration, const std::filesystem::path& run);

/// Holds a new calibration against the active one: sensors that have each other's parameters fail the check
/// `exchange`. Not where the serial numbers tell of another sensor: of that the run asked its operator.
void hold_against(const calib::calibration::Calibration& active, calib::fit::FitReport& report);

}  // namespace mgtd::daemon::acquire
