// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/method_choice/fit.h"

#include <algorithm>

#include "calib/fit/checks/gauge_text.h"
#include "calib/fit/checks/joint_checks.h"
#include "calib/fit/checks/two_step_checks.h"
#include "calib/fit/joint/joint_report.h"
#include "calib/fit/two_step/two_step_report.h"

namespace mgtd::calib::fit::method_choice {

Result<FitReport> fit(const PoseTable& table, const FitOptions& options) {
  const bool joint = options.method == Method::joint;
  auto report = joint ? joint::joint_report(table, options) : two_step::two_step_report(table, options);
  if (!report) return report;
  calibration::Calibration& c = report->calibration;
  c.gauge = checks::gauge_text(*report);
  c.checks = joint ? checks::joint_checks(*report, options) : checks::two_step_checks(*report, options);
  c.accepted_by_checks =
      std::all_of(c.checks.begin(), c.checks.end(), [](const Check& check) { return check.passed; });
  c.seal();
  return report;
}

}  // namespace mgtd::calib::fit::method_choice
