// SPDX-License-Identifier: Apache-2.0
#include "calib/report/fit_report_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "calib/calibration/field_expansion.h"
#include "calib/calibration/tensor.h"
#include "calib/report/array_text.h"
#include "calib/report/fit_reasons.h"
#include "calib/report/fit_summary_text.h"
#include "calib/report/residual_words.h"
#include "calib/report/shown_number.h"
#include "calib/sensor/shown_parameters.h"
#include "proto/units.h"

namespace mgtd::calib::report {
namespace {

std::string error_row(std::string_view stage, const fit::ErrorSummary& errors) {
  std::string row = fmt::format("{:<12}", stage);
  for (const double rmse : errors.total_field_rmse_nT) row += fmt::format(" {:>8.3f}", rmse);
  row += "  ";
  const Gradient& g = errors.tensor_rmse_nT_per_m;
  const auto all = components(g);
  if (std::all_of(all.begin(), all.end(), [](double rmse) { return std::isnan(rmse); })) return row + "\n";
  for (const double rmse : all) row += " " + shown_number(rmse, 9, 3);
  return row + "\n";
}

/// As many decimals as show two digits of the standard deviation.
std::string with_sd(double value, double sd) {
  if (!(sd > 0)) return fmt::format("{:.6g}", value);
  const int decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(sd))), 0, 9);
  return fmt::format("{:.{}f} ± {:.{}f}", value, decimals, sd, decimals);
}

/// Characters as they are seen: of UTF-8, all but the bytes that continue one.
std::size_t seen_width(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

/// A number whose standard deviation is tiny is long: the columns are as wide as the longest of them.
std::string parameter_table(const calibration::Calibration& c) {
  constexpr std::size_t kUsual = 24, kSpace = 2;
  std::vector<PerSensor<std::string>> cells;
  std::size_t width = kUsual;
  for (int k = 0; k < sensor::kSensorParameters; ++k) {
    const sensor::ShownParameter& shown = sensor::shown_parameters()[static_cast<std::size_t>(k)];
    PerSensor<std::string>& row = cells.emplace_back(c.sensors.size());
    for (std::size_t i = 0; i < c.sensors.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i) * sensor::kSensorParameters + k;
      const double sd = std::sqrt(std::max(0.0, c.covariance(at, at)));
      row.at(i) = with_sd(c.sensors[i].parameters()[k] * shown.factor, sd * shown.factor);
      width = std::max(width, seen_width(row.at(i)) + kSpace);
    }
  }
  std::string out = fmt::format("{:<12}", "parameter");
  for (std::size_t i = 0; i < c.sensors.size(); ++i)
    out += fmt::format("{:>{}}", fmt::format("s{}", i + 1), width);
  out += "\n";
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const sensor::ShownParameter& shown = sensor::shown_parameters()[k];
    out += fmt::format("{:<12}", fmt::format("{} {}", shown.name, shown.unit));
    for (const std::string& cell : cells[k]) out += fmt::format("{:>{}}", cell, width);
    out += "\n";
  }
  return out;
}

std::string effect_table(const std::vector<calibration::CalibratedEffect>& effects) {
  std::string out;
  for (const calibration::CalibratedEffect& e : effects) {
    for (const calibration::EffectCoefficient& c : e.coefficients) {
      out += fmt::format("{:<28}{:>24} {}\n", fmt::format("{} {}", e.effect, c.name), with_sd(c.value, c.sd),
                         c.unit);
    }
  }
  return out;
}

std::string halves_table(const fit::HalvesComparison& halves) {
  std::string out = "step 2 from each half of the standard set (odd less even, deg)\n";
  const auto row = [&](std::string_view name, double sensor::SensorModel::*angle) {
    out += fmt::format("{:<12}", name);
    for (std::size_t i = 0; i < halves.odd_sensors.size(); ++i) {
      out += fmt::format("{:>24.5f}", to_deg(halves.odd_sensors[i].*angle - halves.even_sensors[i].*angle));
    }
    out += "\n";
  };
  row("alpha", &sensor::SensorModel::alpha_rad);
  row("beta", &sensor::SensorModel::beta_rad);
  row("gamma", &sensor::SensorModel::gamma_rad);
  return out;
}

std::string check_list(const std::vector<Check>& checks) {
  std::string out = "checks\n";
  for (const Check& check : checks) {
    out += fmt::format("  {:<5} {:<20} {} (limit {})\n", check.passed ? "ok" : "FAIL", check.name,
                       check.measured, check.limit);
    if (!check.passed && !check.remedy.empty()) out += fmt::format("        -> {}\n", check.remedy);
  }
  return out;
}

/// Nothing of the cross, which tells everything.
std::string array_line(const sensor::Geometry& geometry) {
  if (geometry.cross_baseline_m()) return {};
  const auto& places_P_m = geometry.positions_P_m();
  const auto expansion = calibration::FieldExpansion::of({places_P_m.data(), places_P_m.size()});
  return expansion ? what_it_tells(*expansion) : std::string();
}

std::string heading(const fit::FitReport& report) {
  const calibration::Calibration& c = report.calibration;
  std::string out = fmt::format("{} calibration {} of {} poses: {}\n", c.method, c.id, c.poses,
                                c.accepted_by_checks ? "accepted by its checks" : "NOT ACCEPTED");
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
  if (report.table_sd_rad > 0) {
    out += fmt::format("table: each angle good to {:.4f} deg, estimated; chi-square {:.4g} for {:.0f}\n",
                       to_deg(report.table_sd_rad), report.chi2_table, report.dof_table);
  }
  return out;
}

}  // namespace

std::string rows_text(const fit::FitReport& report) {
  std::string out =
      "total field: |b| of each sensor less the F of its pose; tensor: what a uniform field leaves of it, "
      "effects "
      "of the "
      "site that are in the model taken out";
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

std::string error_table(const fit::FitReport& report) {
  const std::size_t sensors = report.calibration.sensors.size();
  const bool tensor = !std::isnan(calibration::root_mean_square(report.after.tensor_rmse_nT_per_m));
  std::string out =
      fmt::format("{:<12}{:^{}}", "rms error", "total field, nT", std::max<std::size_t>(16, 9 * sensors));
  if (tensor) out += fmt::format("  {:^60}", "tensor, nT/m");
  out += fmt::format("\n{:<12}", "");
  for (std::size_t i = 1; i <= sensors; ++i) out += fmt::format("{:>9}", fmt::format("s{}", i));
  if (tensor)
    out += fmt::format("  {:>10}{:>10}{:>10}{:>10}{:>10}{:>10}", "xx", "yy", "zz", "xy", "xz", "yz");
  out += "\n";
  out += error_row("before", report.before);
  if (report.simplified) out += error_row("simplified", *report.simplified);
  out += error_row("step 1", report.after_step1);
  if (report.two_step) out += error_row("two-step", *report.two_step);
  out += error_row(report.calibration.method, report.after);
  if (report.halves) {
    out += error_row("  odd half", report.halves->odd);
    out += error_row("  even half", report.halves->even);
  }
  if (report.held_out) out += error_row("held out", *report.held_out);
  if (report.check_poses) out += error_row("check poses", *report.check_poses);
  return out + rows_text(report) + "\n";
}

std::string to_text(const fit::FitReport& report) {
  std::string out = heading(report) + "\n" + error_table(report) + "\n" + parameter_table(report.calibration);
  if (!report.calibration.effects.empty()) out += "\n" + effect_table(report.calibration.effects);
  if (report.halves) out += "\n" + halves_table(*report.halves);
  if (!report.calibration.checks.empty()) out += "\n" + check_list(report.calibration.checks);
  for (const std::string& reason : fit_reasons(report)) out += fmt::format("note: {}\n", reason);
  return out;
}

}  // namespace mgtd::calib::report
