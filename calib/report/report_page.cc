// SPDX-License-Identifier: Apache-2.0
#include "calib/report/report_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "calib/fit/joint/table_ceiling.h"
#include "calib/report/choice_text.h"
#include "calib/report/comparison_report.h"
#include "calib/report/figures/escaped.h"
#include "calib/report/fit_reasons.h"
#include "calib/report/fit_report_text.h"
#include "calib/report/html.h"
#include "calib/report/noise_text.h"
#include "calib/report/outlier_text.h"
#include "calib/report/residual_words.h"
#include "calib/report/shown_number.h"
#include "calib/report/verdict_text.h"
#include "calib/stats/probability.h"
#include "proto/units.h"

namespace mgtd::calib::report {

using figures::escaped;

namespace {

std::string temperatures(const PoseTable& table) {
  double low = 1e9, high = -1e9;
  for (const Pose& pose : table.poses) {
    for (const auto& T : pose.T_degC)
      if (T) low = std::min(low, *T), high = std::max(high, *T);
  }
  return low > high ? "not measured" : fmt::format("{:.2f} to {:.2f} °C", low, high);
}

std::string duration(const PoseTable& table) {
  const auto &a = table.poses.front().t_s, &b = table.poses.back().t_s;
  return a && b ? fmt::format("{:.0f} minutes", (*b - *a) / 60) : "not recorded";
}

std::vector<std::string> error_cells(const std::string& name, const fit::ErrorSummary& e, bool tensor) {
  std::vector<std::string> out{name};
  const auto add = [&](double x) { out.push_back(shown_number(x, 0, 3)); };
  for (const double x : e.total_field_rmse_nT) add(x);
  if (!tensor) return out;
  for (const double x : components(e.tensor_rmse_nT_per_m)) add(x);
  return out;
}

/// The field in the platform frame at zero table angles.
std::string site_text(const ReportContent& c) {
  std::string out = fmt::format("field {:.1f} nT", c.fit.site.f_nT);
  if (std::isfinite(c.fit.site.inclination_rad))
    out += fmt::format(
        ", inclination {:.3f}° ± {:.1g}°, declination {:.3f}° ± {:.1g}° in the frame of the platform",
        to_deg(c.fit.site.inclination_rad), to_deg(c.fit.site.inclination_sd_rad),
        to_deg(c.fit.site.declination_rad), to_deg(c.fit.site.declination_sd_rad));
  return out;
}

std::string banner_class(criticism::search::Finding finding) {
  if (finding == criticism::search::Finding::pass) return "banner pass";
  return finding == criticism::search::Finding::bad_data ? "banner bad" : "banner";
}

/// Poses that an operator left out, which no figure of the page shows.
std::string masked_poses(const figures::DataTable& masked) {
  if (masked.rows.empty()) return "";
  return "<h3>Left out by the operator</h3>" + figures::table_html(masked, true);
}

}  // namespace

std::string measured_section(const ReportContent& c) {
  std::map<std::string, int> sets;
  std::set<std::string> columns;
  for (const Pose& pose : c.table.poses) {
    ++sets[pose.set];
    for (const auto& [name, value] : pose.covariates) columns.insert(name);
  }
  std::vector<std::string> counted;
  for (const auto& [name, count] : sets) counted.push_back(fmt::format("{} {}", count, name));
  const std::size_t masked = c.file.masked.rows.size();
  Rows rows{
      {"poses", fmt::format("{} ({}){}", c.table.poses.size(), fmt::join(counted, ", "),
                            masked == 0 ? "" : fmt::format("; {} more masked by the operator", masked))},
      {"time", duration(c.table)},
      {"temperature of the heads", temperatures(c.table)},
      {"extra columns", columns.empty() ? "none" : fmt::format("{}", fmt::join(columns, ", "))},
      {"data", c.fit.calibration.data_hash}};
  if (!c.file.run.empty()) rows.insert(rows.begin(), {"run", c.file.run});
  rows.push_back({"operator", c.operator_name.empty() ? "not stated (--operator)" : c.operator_name});
  rows.push_back({"site", c.site.empty() ? site_text(c) : c.site + "; " + site_text(c)});
  std::string out = "<h2>What was measured</h2>" + html_table({"", ""}, rows, true);
  Rows instruments;
  for (const InstrumentIdentity& i : c.instruments) {
    const std::string_view serial = serial_of(i);
    instruments.push_back({i.place, i.identity, serial.empty() ? "not told" : std::string(serial)});
  }
  out += instruments.empty()
             ? "<p class=\"quiet\">The file names no instruments.</p>"
             : "<h3>Instruments</h3>" +
                   html_table({"place", "as it names itself", "serial number"}, instruments, true);
  out += masked_poses(c.file.masked) + figures_html(c.drawn.measured);
  const std::vector<std::string> left_out = outlier_texts(c.comparison.outliers);
  if (left_out.empty()) return out + "<p>No reading was left out.</p>";
  out += "<h3>Left out by the fit</h3><ul>";
  for (const std::string& text : left_out) out += "<li>" + escaped(text) + "</li>";
  return out + "</ul>";
}

std::string verdict_section(const ReportContent& c) {
  const std::string word(to_string(c.explained.finding));
  std::string text = sentence(c.explained);
  std::string out = fmt::format("<div class=\"{}\"><strong>{}</strong>{}</div>",
                                banner_class(c.explained.finding), word, escaped(text));
  for (const criticism::search::Choice& choice : c.doubts)
    out += "<p><strong>Open since it was chosen:</strong> " + escaped(to_text(choice)) + ".</p>";
  Rows rows;
  std::set<std::size_t> failed;
  for (const Check& check : c.fit.calibration.checks) {
    if (!check.passed) failed.insert(rows.size());
    rows.push_back({check.name, check.passed ? "passed" : "failed", check.measured, check.limit,
                    check.passed ? "" : check.remedy});
  }
  out += "<h2>Checks of the calibration</h2>" +
         html_table({"check", "", "measured", "limit", "what to do"}, rows, true, failed);
  constexpr double kFarAbove = 3;
  if (c.fit.residual_nT > kFarAbove * c.fit.noise_nT && failed.empty()) {
    out += fmt::format(
        "<p><strong>The checks catch blunders; they do not say that the model is complete.</strong> The "
        "residual is "
        "{:.3g} times the noise: look at what the model leaves and what could be missing.</p>",
        c.fit.residual_nT / c.fit.noise_nT);
  }
  for (const std::string& reason : fit_reasons(c.fit))
    out += "<p class=\"quiet\">" + escaped(reason) + "</p>";
  return out + html_good(
                   "every check passed, and the residual is near the noise. A calibration that fails a check "
                   "is not accepted by itself.");
}

std::string errors_section(const ReportContent& c) {
  const bool tensor = tells_tensor(c.fit);
  Rows rows;
  const auto add = [&](const char* name, const fit::ErrorSummary& e) {
    rows.push_back(error_cells(name, e, tensor));
  };
  add("before", c.fit.before);
  if (c.fit.simplified) add("simplified", *c.fit.simplified);
  if (c.fit.two_step) add("two-step", *c.fit.two_step);
  add("joint", c.fit.after);
  if (c.fit.held_out) add("poses left out", *c.fit.held_out);
  if (c.fit.check_poses) add("check poses", *c.fit.check_poses);
  std::vector<std::string> head{""};
  for (std::size_t i = 1; i <= c.fit.calibration.sensors.size(); ++i) head.push_back(fmt::format("s{}", i));
  if (tensor) head.insert(head.end(), {"xx", "yy", "zz", "xy", "xz", "yz"});
  return std::string(
             "<h2>Errors before and after</h2><p class=\"quiet\">Root mean squares over the poses, nT") +
         (tensor ? " and nT/m; " : "; ") + escaped(rows_text(c.fit)) + ".</p>" +
         html_table(head, rows, false) +
         html_good(fmt::format(
             "the last rows agree with each other (nothing was overfitted) and lie near the noise of a "
             "pose mean, {:.3g} nT.",
             c.fit.noise_nT));
}

std::string noise_section(const ReportContent& c) {
  const criticism::tests::Comparison& m = c.comparison;
  std::string out = fmt::format(
      "<h2>Noise</h2><p>Noise of a pose mean {:.3g} nT, {}. Residual {:.3g} nT ({}). {}</p>", m.noise_nT,
      noise_source(m.noise.known), m.residual_nT, kResidualIs, escaped(as_sentence(noise_of_tests(m.noise))));
  Rows rows{{"chi-square", fmt::format("{:.4g} with {:.0f} degrees of freedom{}", m.chi2, m.dof,
                                       m.log10_p ? "; " + stats::p_phrase(*m.log10_p) : "")},
            {"correlation from pose to pose", fmt::format("{:.2f}", m.noise.rho)}};
  if (m.noise.revisits)
    rows.push_back(
        {"revisits", fmt::format("{} pairs of one attitude scatter {:.2f} times that noise; lack of fit {}",
                                 m.noise.revisits->pairs, std::sqrt(m.noise.revisits->ratio),
                                 stats::p_phrase(m.noise.revisits->log10_p))});
  if (m.table_sd_deg > 0)
    rows.push_back({"table angles", fmt::format("good to {:.3g}°{} each, estimated", m.table_sd_deg,
                                                fit::joint::or_more(to_rad(m.table_sd_deg)))});
  out += html_table({"", ""}, rows, true);
  Rows axes;
  for (Eigen::Index s = 0; s < m.axis_noise_nT.rows(); ++s) {
    std::vector<std::string> row{fmt::format("s{}", s + 1)};
    for (const auto* of : {&m.axis_noise_nT, &m.axis_residual_nT})
      for (Eigen::Index a = 0; a < 3; ++a) row.push_back(fmt::format("{:.3g}", (*of)(s, a)));
    axes.push_back(std::move(row));
  }
  return out +
         html_table({"sensor", "noise x, nT", "y, nT", "z, nT", "residual x, nT", "y, nT", "z, nT"}, axes,
                    false) +
         html_good(fmt::format(
             "the residual is as large as the noise, axis by axis. Here it is {:.2f} times as large.",
             m.residual_nT / std::max(m.noise_nT, 1e-300)));
}

std::string residual_section(const ReportContent& c) {
  std::string out = "<h2>What the model leaves</h2>";
  out += c.explained.model.empty() ? "<p>Nothing was added to the model: each figure shows it as it is.</p>"
                                   : "<p>Left of each figure the sensors' parameters alone, right with the "
                                     "effects that the search ended with; both on "
                                     "equal axes.</p>";
  out += figures_html(c.drawn.panels);
  for (const std::string& line : alike_text(c.comparison))
    out += "<p class=\"quiet\">" + escaped(line) + ".</p>";
  return out + html_good(
                   "points that scatter about zero without a shape. What follows something on the scalar "
                   "residual alone is a "
                   "sensor, on the attitude alone the table, alike in all sensors the site.");
}

std::string report_page(const ReportContent& c) {
  std::string out = fmt::format(
      "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\"><title>{0}: calibration "
      "report</title><style>{1}</style></head><body><header>"
      "<h1>Calibration report</h1><div class=\"quiet\">{0} · calibration {2} · {3}</div></header><main>",
      escaped(c.run), html_style(), escaped(c.fit.calibration.id), escaped(c.fit.calibration.software));
  for (const auto section :
       {verdict_section, measured_section, noise_section, limits_section, rounds_section, waterfall_section,
        residual_section, candidates_section, laws_section, errors_section, parameters_section, next_section,
        judgements_section, history_section})
    out += section(c);
  return out + fmt::format(
                   "</main><footer>Made by <code>{}</code>. This page loads nothing and runs "
                   "nothing.</footer></body></html>\n",
                   escaped(c.command));
}

}  // namespace mgtd::calib::report
