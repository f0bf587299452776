// SPDX-License-Identifier: Apache-2.0
#include "calib/report/calibration_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/calibration/field_expansion.h"
#include "calib/report/array_text.h"
#include "calib/report/column_blocks.h"
#include "calib/sensor/shown_parameters.h"

namespace mgtd::calib::report {
namespace {

constexpr std::size_t kUsualCell = 24, kSpace = 2;

NamedRow parameter_row(const calibration::Calibration& c, int k) {
  const sensor::ShownParameter& p = sensor::shown_parameters()[static_cast<std::size_t>(k)];
  NamedRow row{fmt::format("{} {}", p.name, p.unit), {}};
  for (std::size_t i = 0; i < c.sensors.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i) * sensor::kSensorParameters + k;
    const double sd = std::sqrt(std::max(0.0, c.covariance(at, at)));
    row.cells.push_back(with_sd(c.sensors[i].parameters()[k] * p.factor, sd * p.factor));
  }
  return row;
}

/// When and of what it was made, as far as it says so.
std::string origin(const calibration::Calibration& c) {
  std::string out;
  if (!c.reference.t_utc.empty()) out += fmt::format("poses: from {}\n", c.reference.t_utc);
  if (c.reference.f_nT) out += fmt::format("site:  F {:.2f} nT\n", *c.reference.f_nT);
  const double left_nT = calibration::root_mean_square(c.pose_noise_nT);
  if (left_nT > 0) out += fmt::format("noise: {:.3g} nT of a pose mean\n", left_nT);
  if (!c.software.empty()) out += fmt::format("by:    {}\n", c.software);
  return out;
}

}  // namespace

std::string with_sd(double value, double sd) {
  if (!(sd > 0)) return fmt::format("{:.6g}", value);
  constexpr double kLeast = 1e-8;  // below it decimals show nothing
  if (sd < kLeast) return fmt::format("{:.5g} ± {:.2g}", value, sd);
  const int decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(sd))), 0, 9);
  return fmt::format("{:.{}f} ± {:.{}f}", value, decimals, sd, decimals);
}

std::string parameter_table(const calibration::Calibration& c, std::size_t width) {
  std::vector<NamedRow> rows{{"parameter", {}}};
  for (std::size_t i = 0; i < c.sensors.size(); ++i) rows.front().cells.push_back(fmt::format("s{}", i + 1));
  std::size_t cell = 0;  // a number whose standard deviation is tiny is long
  for (int k = 0; k < sensor::kSensorParameters; ++k) {
    rows.push_back(parameter_row(c, k));
    for (const std::string& text : rows.back().cells) cell = std::max(cell, seen_width(text) + kSpace);
  }
  constexpr std::size_t kName = 12;
  const std::size_t usual = std::max(kUsualCell, cell);
  const bool fits = width >= kName && (width - kName) / usual >= c.sensors.size();
  return column_blocks(rows, kName, fits ? usual : cell, width);
}

/// Of a formula with several coefficients the text stands once, above them.
std::string effect_table(const std::vector<calibration::CalibratedEffect>& effects) {
  std::string out;
  for (const calibration::CalibratedEffect& e : effects) {
    const bool once = e.coefficients.size() > 1 && e.effect.find("expr=") != std::string::npos;
    if (once) out += e.effect + "\n";
    for (const calibration::EffectCoefficient& c : e.coefficients)
      out += fmt::format("{:<28}{:>24} {}\n", fmt::format("{} {}", once ? " " : e.effect, c.name),
                         with_sd(c.value, c.sd), c.unit);
  }
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

std::string array_line(const sensor::Geometry& geometry) {
  if (geometry.cross_baseline_m()) return {};
  const auto& places_P_m = geometry.positions_P_m();
  const auto expansion = calibration::FieldExpansion::of({places_P_m.data(), places_P_m.size()});
  return expansion ? what_it_tells(*expansion) : std::string();
}

std::string calibration_heading(const calibration::Calibration& c) {
  return fmt::format("{} calibration {} of {} poses: {}\n", c.method, c.id, c.poses,
                     c.accepted_by_checks ? "accepted by its checks" : "NOT ACCEPTED");
}

std::string to_text(const calibration::Calibration& c, std::size_t width) {
  std::string out = calibration_heading(c) + fmt::format("gauge: {}\n", c.gauge);
  if (const std::string array = array_line(c.geometry); !array.empty())
    out += fmt::format("array: {}\n", array);
  out += origin(c) + "\n" + parameter_table(c, width);
  if (!c.effects.empty()) out += "\n" + effect_table(c.effects);
  if (!c.checks.empty()) out += "\n" + check_list(c.checks);
  return out;
}

}  // namespace mgtd::calib::report
