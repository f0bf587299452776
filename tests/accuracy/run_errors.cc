// SPDX-License-Identifier: Apache-2.0
#include "tests/accuracy/run_errors.h"

#include <cmath>
#include <stdexcept>

#include "calib/fit/error_summary.h"
#include "calib/fit/readings.h"
#include "tests/accuracy/campaign.h"

namespace mgtd::testing {
namespace {

using calib::fit::ErrorSummary;

calib::fit::FitReport fitted(const PoseTable& table, calib::fit::FitOptions options,
                             calib::fit::Method method) {
  options.method = method;
  if (method != calib::fit::Method::joint) options.effects.clear();
  auto report = calib::fit::method_choice::fit(table, options);
  if (!report) throw std::runtime_error(report.error().text());
  return *std::move(report);
}

/// Adds the squares, so that the root of the sum over n is the mean.
void add(const ErrorSummary& from, double weight, ErrorSummary& to) {
  for (std::size_t i = 0; i < from.total_field_rmse_nT.size(); ++i) {
    to.total_field_rmse_nT[i] =
        std::hypot(to.total_field_rmse_nT[i], std::sqrt(weight) * from.total_field_rmse_nT[i]);
  }
  for (double Gradient::*c :
       {&Gradient::xx, &Gradient::yy, &Gradient::zz, &Gradient::xy, &Gradient::xz, &Gradient::yz}) {
    to.tensor_rmse_nT_per_m.*c =
        std::hypot(to.tensor_rmse_nT_per_m.*c, std::sqrt(weight) * from.tensor_rmse_nT_per_m.*c);
  }
}

}  // namespace

RunErrors run_errors(const RigTruth& rig, const PoseTable& table, const calib::fit::FitOptions& options) {
  RunErrors out;
  out.two_step_report = fitted(table, options, calib::fit::Method::two_step);
  out.joint_report = fitted(table, options, calib::fit::Method::joint);
  out.before = out.two_step_report.before;
  out.step1 = out.two_step_report.after_step1;
  out.two_step = out.two_step_report.after;
  out.simplified = out.two_step_report.simplified;
  out.joint = out.joint_report.after;
  if (const auto& halves = out.two_step_report.halves) {
    out.odd = halves->odd;
    out.even = halves->even;
  }
  const auto readings = calib::fit::readings_of(table, options);
  if (!readings) throw std::runtime_error(readings.error().text());
  out.floor = calib::fit::summarise(calib::fit::corrected_fields(*readings, models_of(rig)), readings->f_nT,
                                    options.geometry);
  return out;
}

RunErrors mean_of(const std::vector<RunErrors>& runs) {
  RunErrors out;
  const double weight = 1.0 / static_cast<double>(runs.size());
  for (const RunErrors& run : runs) {
    for (ErrorSummary RunErrors::*s :
         {&RunErrors::before, &RunErrors::step1, &RunErrors::two_step, &RunErrors::joint, &RunErrors::floor})
      add(run.*s, weight, out.*s);
    for (std::optional<ErrorSummary> RunErrors::*s :
         {&RunErrors::simplified, &RunErrors::odd, &RunErrors::even}) {
      if (!(run.*s)) continue;
      if (!(out.*s)) out.*s = ErrorSummary{};
      add(*(run.*s), weight, *(out.*s));
    }
  }
  return out;
}

}  // namespace mgtd::testing
