// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/fit/fit_options.h"
#include "calib/report/report_content.h"
#include "daemon/cli/fit_flags.h"
#include "proto/error.h"

/// ReportWishes name the run of a report, what no run file holds about it, and the file to write.
namespace mgtd::daemon::cli {

struct ReportWishes {
  std::string run, output;
  std::string operator_name, site;   ///< that no run file holds
  std::vector<std::string> earlier;  ///< CAL.json or runs of the same rig, for the history of its parameters
};

/// Reads the run and computes everything that its report shows. `on_round` hears of every round of its fits.
[[nodiscard]] Result<calib::report::ReportContent> report_content(const ReportWishes& wishes,
                                                                  const FitFlags& flags,
                                                                  calib::fit::RoundListener on_round = {});

/// The command line that says the same again: every option that was given, quoted for a shell where that is
/// needed.
[[nodiscard]] std::string report_command(const ReportWishes& wishes, const FitFlags& flags);

}  // namespace mgtd::daemon::cli
