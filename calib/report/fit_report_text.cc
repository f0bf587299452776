// SPDX-License-Identifier: Apache-2.0
#include "calib/report/fit_report_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "calib/calibration/tensor.h"
#include "calib/fit/joint/joint_findings.h"
#include "calib/fit/joint/table_ceiling.h"
#include "calib/report/calibration_text.h"
#include "calib/report/column_blocks.h"
#include "calib/report/fit_reasons.h"
#include "calib/report/fit_summary_text.h"
#include "calib/report/reference_text.h"
#include "calib/report/residual_words.h"
#include "proto/units.h"

namespace mgtd::calib::report {
namespace {

/// One stage of the fit with the cells of its two tables.
struct ErrorRow {
  NamedRow field, tensor;
};

/// At most eight characters, so that a column of any errors stays apart from the next.
std::string error_cell(double rmse) {
  if (std::isnan(rmse)) return "-";
  return rmse < 9'999 ? fmt::format("{:.3f}", rmse)
         : rmse < 1e7 ? fmt::format("{:.0f}", rmse)
                      : fmt::format("{:.1e}", rmse);
}

ErrorRow error_row(const std::string& stage, const fit::ErrorSummary& errors) {
  ErrorRow row{{stage, {}}, {stage, {}}};
  for (const double rmse : errors.total_field_rmse_nT) row.field.cells.push_back(error_cell(rmse));
  const auto all = components(errors.tensor_rmse_nT_per_m);
  const bool determined = !std::all_of(all.begin(), all.end(), [](double rmse) { return std::isnan(rmse); });
  for (const double rmse : all) row.tensor.cells.push_back(determined ? error_cell(rmse) : "");
  return row;
}

std::vector<ErrorRow> error_rows(const fit::FitReport& report) {
  std::vector<ErrorRow> rows{{{"", {}}, {"", {"xx", "yy", "zz", "xy", "xz", "yz"}}}};
  for (std::size_t i = 1; i <= report.calibration.sensors.size(); ++i)
    rows.front().field.cells.push_back(fmt::format("s{}", i));
  rows.push_back(error_row("before", report.before));
  if (report.simplified) rows.push_back(error_row("simplified", *report.simplified));
  rows.push_back(error_row("step 1", report.after_step1));
  if (report.two_step) rows.push_back(error_row("two-step", *report.two_step));
  rows.push_back(error_row(report.calibration.method, report.after));
  if (report.halves) {
    rows.push_back(error_row("  odd half", report.halves->odd));
    rows.push_back(error_row("  even half", report.halves->even));
  }
  if (report.held_out) rows.push_back(error_row("held out", *report.held_out));
  if (report.check_poses) rows.push_back(error_row("check poses", *report.check_poses));
  return rows;
}

constexpr std::size_t kStage = 12, kFieldCell = 9, kTensorCell = 10;

/// Field and tensor beside each other.
std::string error_table_in_one(const std::vector<ErrorRow>& rows, bool tensor) {
  const std::size_t sensors = rows.front().field.cells.size();
  std::string out = fmt::format("{:<{}}{:^{}}", "rms error", kStage, "total field, nT",
                                std::max<std::size_t>(16, kFieldCell * sensors));
  if (tensor) out += fmt::format("  {:^60}", "tensor, nT/m");
  out += "\n";
  for (const ErrorRow& row : rows) {
    out += fmt::format("{:<{}}", row.field.name, kStage);
    for (const std::string& cell : row.field.cells) out += fmt::format("{:>{}}", cell, kFieldCell);
    if (tensor) {
      out += "  ";
      for (const std::string& cell : row.tensor.cells)
        if (!cell.empty()) out += fmt::format("{:>{}}", cell, kTensorCell);
    }
    out += "\n";
  }
  return out;
}

/// The tensor below the field.
std::string error_table_in_two(const std::vector<ErrorRow>& rows, bool tensor, std::size_t width) {
  std::vector<NamedRow> field, gradient;
  for (const ErrorRow& row : rows) {
    field.push_back(row.field);
    if (!row.tensor.cells.front().empty()) gradient.push_back(row.tensor);
  }
  std::string out = "rms error of the total field, nT\n" + column_blocks(field, kStage, kFieldCell, width);
  if (tensor)
    out += "\nrms error of the tensor, nT/m\n" + column_blocks(gradient, kStage, kTensorCell, width);
  return out;
}

std::string halves_table(const fit::HalvesComparison& halves, std::size_t width) {
  std::vector<NamedRow> rows{{"", {}}};
  for (std::size_t i = 0; i < halves.odd_sensors.size(); ++i)
    rows.front().cells.push_back(fmt::format("s{}", i + 1));
  const auto add = [&](const std::string& name, double sensor::SensorModel::*angle) {
    NamedRow& row = rows.emplace_back(NamedRow{name, {}});
    for (std::size_t i = 0; i < halves.odd_sensors.size(); ++i)
      row.cells.push_back(
          fmt::format("{:.5f}", to_deg(halves.odd_sensors[i].*angle - halves.even_sensors[i].*angle)));
  };
  add("alpha", &sensor::SensorModel::alpha_rad);
  add("beta", &sensor::SensorModel::beta_rad);
  add("gamma", &sensor::SensorModel::gamma_rad);
  constexpr std::size_t kName = 12, kWide = 24, kNarrow = 12;
  const bool fits = width >= kName && (width - kName) / kWide >= halves.odd_sensors.size();
  return "step 2 from each half of the standard set (odd less even, deg)\n" +
         column_blocks(rows, kName, fits ? kWide : kNarrow, width);
}

std::string heading(const fit::FitReport& report) {
  const calibration::Calibration& c = report.calibration;
  std::string out = calibration_heading(c);
  out += fmt::format("fit:   {}\n", to_text(report.summary));
  out += fmt::format("gauge: {}\n", c.gauge);
  if (const std::string array = array_line(c.geometry); !array.empty())
    out += fmt::format("array: {}\n", array);
  out += fmt::format("site:  F {:.2f} nT", report.site.f_nT);
  if (!std::isnan(report.site.inclination_rad)) {
    out += fmt::format(", inclination {} deg, declination {} deg",
                       with_sd(to_deg(report.site.inclination_rad), to_deg(report.site.inclination_sd_rad)),
                       with_sd(to_deg(report.site.declination_rad), to_deg(report.site.declination_sd_rad)));
  }
  out += "\n";
  if (report.dof > 0) {
    out += fmt::format("noise: {:.3g} nT of a pose mean, {}\n", report.noise_nT,
                       noise_source(report.noise_known));
  }
  if (report.residual_nT > 0) {
    out += fmt::format("residual: {:.3g} nT", report.residual_nT);
    if (report.held_out_residual_nT)
      out += fmt::format(", on poses held out {:.3g} nT", *report.held_out_residual_nT);
    out += fmt::format(" ({})\n", kResidualIs);
  }
  if (report.dof > 0) {
    out += fmt::format("chi-square: {:.5g} for {:.0f} degrees of freedom, of {}\n", report.chi2, report.dof,
                       report.residual_nT > 0 ? "readings and scalar reference" : "|b| less F");
  }
  if (report.table.sd_rad > 0) {
    out += fmt::format("table: each angle good to {:.4f} deg{}, estimated; chi-square {:.4g} for {:.0f}\n",
                       to_deg(report.table.sd_rad), fit::joint::or_more(report.table.sd_rad),
                       report.table.chi2, report.table.dof);
  }
  if (report.joint && report.joint->reference_scatter)
    out += fmt::format("reference: {}\n", reference_scatter_text(*report.joint->reference_scatter));
  return out;
}

}  // namespace

bool tells_tensor(const fit::FitReport& report) {
  return !std::isnan(calibration::root_mean_square(report.after.tensor_rmse_nT_per_m));
}

std::string rows_text(const fit::FitReport& report) {
  std::string out = "total field: |b| of each sensor less the F of its pose";
  if (tells_tensor(report))
    out += "; tensor: what a uniform field leaves of it, effects of the site that are in the model taken out";
  std::vector<std::string> readings;
  for (const fit::OutlierNode& o : report.outliers)
    if (o.where != "angles")
      readings.push_back(o.where == "pose" ? fmt::format("all of pose {}", o.pose)
                                           : fmt::format("{} of pose {}", o.where, o.pose));
  if (!readings.empty()) {
    out += fmt::format("; no row counts {} that the fit left out: {}",
                       readings.size() == 1 ? "the reading" : fmt::format("the {} readings", readings.size()),
                       fmt::join(readings, ", "));
  }
  return out;
}

std::string error_table(const fit::FitReport& report, std::size_t width) {
  const std::size_t sensors = report.calibration.sensors.size();
  const bool tensor = tells_tensor(report);
  const std::size_t needed = kStage + kFieldCell * sensors + (tensor ? 2 + 6 * kTensorCell : 0);
  const auto rows = error_rows(report);
  return (needed <= width ? error_table_in_one(rows, tensor) : error_table_in_two(rows, tensor, width)) +
         rows_text(report) + "\n";
}

std::string to_text(const fit::FitReport& report, std::size_t width) {
  const calibration::Calibration& c = report.calibration;
  std::string out = heading(report) + "\n" + error_table(report, width) + "\n" + parameter_table(c, width);
  if (!c.effects.empty()) out += "\n" + effect_table(c.effects);
  if (report.halves) out += "\n" + halves_table(*report.halves, width);
  if (!c.checks.empty()) out += "\n" + check_list(c.checks);
  for (const std::string& reason : fit_reasons(report)) out += fmt::format("note: {}\n", reason);
  return out;
}

}  // namespace mgtd::calib::report
