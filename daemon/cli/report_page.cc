// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/report_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "calib/report/choice_text.h"
#include "calib/report/comparison_report.h"
#include "calib/report/fit_reasons.h"
#include "calib/report/fit_report_text.h"
#include "calib/report/noise_text.h"
#include "calib/report/residual_words.h"
#include "calib/report/verdict_text.h"
#include "calib/stats/probability.h"
#include "daemon/cli/html.h"
#include "daemon/cli/svg.h"
#include "proto/units.h"

namespace mgtd::daemon::cli {
namespace {

std::string number(double x) { return fmt::format("{:.3f}", x); }

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

std::vector<std::string> error_row(const std::string& name, const calib::fit::ErrorSummary& e) {
  std::vector<std::string> out{name};
  for (const double x : e.total_field_rmse_nT) out.push_back(number(x));
  const Gradient& g = e.tensor_rmse_nT_per_m;
  for (const double x : {g.xx, g.yy, g.zz, g.xy, g.xz, g.yz}) out.push_back(number(x));
  return out;
}

std::string banner_class(calib::criticism::search::Finding finding) {
  if (finding == calib::criticism::search::Finding::pass) return "banner pass";
  return finding == calib::criticism::search::Finding::bad_data ? "banner bad" : "banner";
}

}  // namespace

std::string measured_section(const ReportContent& c) {
  std::map<std::string, int> sets;
  std::set<std::string> columns;
  for (const Pose& pose : c.source.table.poses) {
    ++sets[pose.set];
    for (const auto& [name, value] : pose.covariates) columns.insert(name);
  }
  std::vector<std::string> counted;
  for (const auto& [name, count] : sets) counted.push_back(fmt::format("{} {}", count, name));
  Rows rows{{"poses", fmt::format("{} ({})", c.source.table.poses.size(), fmt::join(counted, ", "))},
            {"time", duration(c.source.table)},
            {"field", fmt::format("{:.1f} nT", c.fit.site.f_nT)},
            {"temperature of the heads", temperatures(c.source.table)},
            {"extra columns", columns.empty() ? "none" : fmt::format("{}", fmt::join(columns, ", "))},
            {"data", c.fit.calibration.data_hash}};
  if (c.source.header) {
    const store::RunHeader& h = *c.source.header;
    const std::string started = h.started_utc.ns == 0
                                    ? "start not recorded"
                                    : fmt::format("started {:.19}Z", format_utc(h.started_utc));
    rows.insert(rows.begin(), {"run", fmt::format("{} on rig {}, {}", h.run_id, h.rig, started)});
  }
  return "<h2>What was measured</h2>" + html_table({"", ""}, rows, true);
}

std::string verdict_section(const ReportContent& c) {
  const std::string word(to_string(c.explained.finding));
  std::string text = calib::report::sentence(c.explained);
  std::string out = fmt::format("<div class=\"{}\"><strong>{}</strong>{}</div>",
                                banner_class(c.explained.finding), word, escaped(text));
  for (const calib::criticism::search::Choice& choice : c.doubts)
    out +=
        "<p><strong>Open since it was chosen:</strong> " + escaped(calib::report::to_text(choice)) + ".</p>";
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
  for (const std::string& reason : calib::report::fit_reasons(c.fit))
    out += "<p class=\"quiet\">" + escaped(reason) + "</p>";
  return out + html_good(
                   "every check passed, and the residual is near the noise. A calibration that fails a check "
                   "is not accepted by itself.");
}

std::string errors_section(const ReportContent& c) {
  Rows rows{error_row("before", c.fit.before)};
  if (c.fit.simplified) rows.push_back(error_row("simplified", *c.fit.simplified));
  if (c.fit.two_step) rows.push_back(error_row("two-step", *c.fit.two_step));
  rows.push_back(error_row("joint", c.fit.after));
  if (c.fit.held_out) rows.push_back(error_row("poses left out", *c.fit.held_out));
  if (c.fit.check_poses) rows.push_back(error_row("check poses", *c.fit.check_poses));
  return "<h2>Errors before and after</h2><p class=\"quiet\">Root mean squares over the poses, nT and "
         "nT/m; " +
         escaped(calib::report::rows_text(c.fit)) + ".</p>" +
         html_table({"", "s1", "s2", "s3", "s4", "xx", "yy", "zz", "xy", "xz", "yz"}, rows, false) +
         html_good(fmt::format(
             "the last rows agree with each other (nothing was overfitted) and lie near the noise of a "
             "pose mean, {:.3g} nT.",
             c.fit.noise_nT));
}

std::string residual_section(const ReportContent& c) {
  constexpr double kStandsOut = -3;
  std::string out = fmt::format(
      "<h2>What the model leaves</h2><p>Residual {:.3g} nT ({}); noise of a pose mean {:.3g} nT, {}. {}</p>"
      "<p class=\"quiet\">Each row is a way of looking at it, each plot its means over a covariate, of the "
      "component that depends most.</p>",
      c.comparison.residual_nT, calib::report::kResidualIs, c.comparison.noise_nT,
      calib::report::noise_source(c.comparison.noise.known),
      escaped(calib::report::as_sentence(calib::report::noise_of_tests(c.comparison.noise))));
  for (const calib::criticism::tests::ResidualChannel& channel : c.comparison.channels) {
    double scale = 0;
    for (const calib::criticism::tests::Dependence& d : channel.against)
      for (const double m : d.means) scale = std::max(scale, std::abs(m));
    out += fmt::format("<h3>{} <span class=\"quiet\">rms {:.3g}{}{}: {}</span></h3><div class=\"plots\">",
                       escaped(channel.name), channel.rms, channel.unit.empty() ? "" : " ",
                       escaped(channel.unit), escaped(channel.meaning));
    for (const calib::criticism::tests::Dependence& d : channel.against) {
      const bool stands_out = d.log10_p < kStandsOut;
      out += fmt::format("<figure{}>{}<figcaption>{}, {}</figcaption></figure>",
                         stands_out ? " class=\"out\"" : "",
                         svg_series({.y = d.means,
                                     .from = d.from,
                                     .to = d.to,
                                     .x_label = d.covariate,
                                     .unit = channel.unit,
                                     .scale = scale,
                                     .stands_out = stands_out}),
                         escaped(d.component), escaped(calib::stats::p_phrase(d.log10_p)));
    }
    out += "</div>";
  }
  for (const std::string& line : calib::report::alike_text(c.comparison))
    out += "<p class=\"quiet\">" + escaped(line) + ".</p>";
  return out +
         html_good(
             "blue points that scatter about the line without a shape. An orange frame (p below 0.001) means "
             "that the residual follows this covariate: on the scalar residual alone it is a sensor, on the "
             "attitude alone the table, alike in all sensors the site. With fifty plots, chance alone makes "
             "a frame "
             "in one report of twenty.");
}

std::string waterfall_section(const ReportContent& c) {
  if (!c.waterfall) return "";
  const calib::criticism::search::Waterfall& w = *c.waterfall;
  std::vector<Bar> bars{{"without any effect", w.without_nT,
                         fmt::format("{:.3g} nT, {:.3g} nT/m", w.without_nT, w.without_nT_per_m), 2}};
  for (const calib::criticism::search::WaterfallStep& s : w.steps) {
    bars.push_back({s.effect + ", added first", s.first_nT,
                    fmt::format("{:.3g} nT, {:.3g} nT/m", s.first_nT, s.first_nT_per_m), 0});
    bars.push_back(
        {"dropped last", s.last_nT, fmt::format("{:.3g} nT, {:.3g} nT/m", s.last_nT, s.last_nT_per_m), 1});
  }
  bars.push_back(
      {"with all of them", w.with_nT, fmt::format("{:.3g} nT, {:.3g} nT/m", w.with_nT, w.with_nT_per_m), 2});
  return "<h2>What each effect takes out</h2><p class=\"quiet\">Parts add in squares: a bar is the part of "
         "the residual, nT, that one effect accounts for; beside it the same of the error of the tensor, rms "
         "of its "
         "six components.</p>" +
         svg_bars(bars, w.floor_nT, fmt::format("noise {:.3g} nT", w.floor_nT)) +
         html_good(
             "the last bar ends at the noise. Where the two bars of an effect differ, it shares what it "
             "explains with "
             "another one.");
}

}  // namespace mgtd::daemon::cli
