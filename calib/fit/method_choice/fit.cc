// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/method_choice/fit.h"

#include <algorithm>

#include "calib/fit/checks/gauge_text.h"
#include "calib/fit/checks/joint_checks.h"
#include "calib/fit/checks/two_step_checks.h"
#include "calib/fit/joint/joint_report.h"
#include "calib/fit/two_step/two_step_report.h"

namespace mgtd::calib {

std::string_view name(Method method) {
  switch (method) {
    case Method::simplified:
      return "simplified";
    case Method::two_step:
      return "two-step";
    case Method::joint:
      return "joint";
  }
  return "";
}

std::optional<Method> method_from(std::string_view text) {
  for (const Method method : {Method::simplified, Method::two_step, Method::joint}) {
    if (name(method) == text) return method;
  }
  return std::nullopt;
}

Result<FitReport> fit(const PoseTable& table, const FitOptions& options) {
  const bool joint = options.method == Method::joint;
  auto report = joint ? joint_report(table, options) : two_step_report(table, options);
  if (!report) return report;
  Calibration& c = report->calibration;
  c.gauge = gauge_text(*report);
  c.checks = joint ? joint_checks(*report, options) : two_step_checks(*report, options);
  c.accepted_by_checks =
      std::all_of(c.checks.begin(), c.checks.end(), [](const Check& check) { return check.passed; });
  c.seal();
  return report;
}

}  // namespace mgtd::calib
