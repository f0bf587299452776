// SPDX-License-Identifier: Apache-2.0
// The second half of the report: candidates, what is not known, and the history of the model.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "calib/criticism/tests/candidate.h"
#include "calib/criticism/tests/detectable.h"
#include "calib/report/fit_reasons.h"
#include "calib/report/size_text.h"
#include "calib/report/verdict_text.h"
#include "calib/stats/probability.h"
#include "daemon/cli/html.h"
#include "daemon/cli/report_page.h"
#include "daemon/cli/svg.h"

namespace mgtd::daemon::cli {
namespace {

constexpr std::size_t kCandidates = 12;

std::string alternatives_text(const calib::criticism::tests::Candidate& candidate) {
  std::vector<std::string> names;
  for (const calib::criticism::tests::Alternative& r : candidate.alternatives)
    if (r.possible) names.push_back(r.effect);
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::string candidates_section(const ReportContent& c) {
  const auto& all = c.explained.candidates;
  if (all.empty()) return "";
  std::vector<Bar> bars;
  Rows rows;
  for (std::size_t i = 0; i < std::min(kCandidates, all.size()); ++i) {
    const calib::criticism::tests::Candidate& x = all[i];
    const bool named =
        std::find(c.explained.named.begin(), c.explained.named.end(), x.effect) != c.explained.named.end();
    bars.push_back({x.effect, x.d, fmt::format("{:.1f}", x.d), named ? 1 : 2});
    rows.push_back({x.effect, x.where, fmt::format("{:.1f}", x.d), calib::stats::p_text(x.log10_p),
                    calib::report::size_text(x), x.plausible ? "" : "beyond what occurs",
                    alternatives_text(x)});
  }
  return "<h2>What could be missing</h2><p class=\"quiet\">Every effect of the library was tried on what the "
         "model "
         "leaves, with calibration, attitude and field free. d is its size in units of its own "
         "uncertainty.</p>" +
         svg_bars(bars, calib::criticism::tests::kSeen,
                  fmt::format("d = {:g}: seen in 99 of 100 runs", calib::criticism::tests::kSeen)) +
         html_table({"effect", "where", "d", "p", "size", "", "could also be"}, rows, true) +
         html_good(
             "all bars short of the dashed line. Orange bars are named by the verdict; a name is a "
             "hypothesis about "
             "the cause, what is measured is that the residual behaves like it.");
}

std::string limits_section(const ReportContent& c) {
  std::string out = "<h2>What this run cannot tell</h2>";
  Rows untestable, detectable, next;
  for (const calib::criticism::tests::Untestable& u : c.explained.untestable)
    untestable.push_back({u.effect, u.why});
  for (const calib::criticism::tests::Detectable& d : c.explained.detectable)
    detectable.push_back({d.effect, calib::report::detectable_text(d)});
  for (const calib::design::NextMeasurement& n : c.explained.next)
    next.push_back({n.action, fmt::format("{:.0f}", n.minutes), fmt::format("{:.3f}", n.p_right_before),
                    fmt::format("{:.3f}", n.p_right_after)});
  out += html_table({"untestable", "why"}, untestable, true);
  for (const std::string& w : calib::report::weak_texts(c.fit))
    out += "<p class=\"quiet\">" + escaped(w) + "</p>";
  if (!next.empty())
    out += "<h3>What would settle the name</h3>" +
           html_table({"measurement", "minutes", "p right now", "p right then"}, next, true);
  out += "<h3>Smallest sizes that would have been seen, in 99 of 100 runs like this</h3>" +
         html_table({"effect", "size (where)"}, detectable, true);
  return out +
         html_good(
             "sizes smaller than what your work can bear. An effect below its size may be there unseen.");
}

std::string parameters_section(const ReportContent& c) {
  const int sensors = static_cast<int>(c.fit.calibration.sensors.size());
  std::vector<std::string> head{""};
  for (int s = 1; s <= sensors; ++s) head.push_back(fmt::format("s{}", s));
  Rows rows;
  for (int k = 0; k < calib::sensor::kSensorParameters; ++k) {
    const bool scale = k >= calib::sensor::cx && k <= calib::sensor::cz,
               offset = k >= calib::sensor::ix && k <= calib::sensor::iz;
    std::vector<std::string> row{std::string(calib::sensor::kParameterNames[static_cast<std::size_t>(k)]) +
                                 (scale    ? ""
                                  : offset ? ", nT"
                                           : ", deg")};
    for (int s = 0; s < sensors; ++s) {
      const int slot = s * calib::sensor::kSensorParameters + k;
      double value = c.fit.calibration.sensors[static_cast<std::size_t>(s)].parameters()[k];
      double sd = std::sqrt(c.fit.calibration.covariance(slot, slot));
      if (!scale && !offset) value = to_deg(value), sd = to_deg(sd);
      row.push_back(scale    ? fmt::format("{:.6f} ± {:.1g}", value, sd)
                    : offset ? fmt::format("{:.3f} ± {:.2g}", value, sd)
                             : fmt::format("{:.5f} ± {:.1g}", value, sd));
    }
    rows.push_back(std::move(row));
  }
  Rows effects;
  for (const calib::calibration::CalibratedEffect& e : c.fit.calibration.effects) {
    for (const calib::calibration::EffectCoefficient& x : e.coefficients)
      effects.push_back({e.effect, x.name, fmt::format("{:+.5g} ± {:.2g} {}", x.value, x.sd, x.unit)});
  }
  std::string out = "<h2>Parameters</h2>" + html_table(head, rows, false);
  if (!effects.empty())
    out += "<h3>Effects in the model</h3>" + html_table({"effect", "coefficient", ""}, effects, true);
  return out + "<p class=\"quiet\">" + escaped(c.fit.calibration.gauge) + "</p>" +
         html_good(
             "scales and offsets as the sensors' certificates say, standard errors far below what matters.");
}

std::string history_section(const ReportContent& c) {
  if (c.history.empty()) return "";
  Rows rows;
  for (const store::ModelStep& s : c.history) {
    const auto result = nlohmann::json::parse(s.result, nullptr, false);
    std::string change;
    if (result.is_object() && result.contains("rms_before_nT"))
      change = fmt::format("{:.3f} → {:.3f} nT", result["rms_before_nT"].get<double>(),
                           result["rms_after_nT"].get<double>());
    rows.push_back({fmt::format("{:.19}Z", format_utc(s.at)), s.action, s.spec, change, s.who});
  }
  return "<h2>How the model came to be</h2>" +
         html_table({"when", "", "effect", "residual before → after", "who"}, rows, true);
}

std::string report_page(const ReportContent& c) {
  std::string out = fmt::format(
      "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\"><title>{0}: calibration report</title><style>{1}</style></head><body>"
      "<h1>Calibration report</h1><div class=\"quiet\">{0} · calibration {2} · {3}</div>",
      escaped(c.run), kHtmlStyle, c.fit.calibration.id, escaped(c.fit.calibration.software));
  for (const auto section :
       {verdict_section, measured_section, errors_section, residual_section, waterfall_section,
        candidates_section, limits_section, parameters_section, history_section})
    out += section(c);
  return out + fmt::format(
                   "<footer>Made by <code>{}</code>. This page loads nothing and runs "
                   "nothing.</footer></body></html>\n",
                   escaped(c.command));
}

}  // namespace mgtd::daemon::cli
