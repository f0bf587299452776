// SPDX-License-Identifier: Apache-2.0
// The second half of the report: candidates, laws, what is not known, and the history of the model.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "calib/report/calibration_text.h"
#include "calib/report/figures/escaped.h"
#include "calib/report/fit_reasons.h"
#include "calib/report/html.h"
#include "calib/report/report_page.h"
#include "calib/report/size_text.h"
#include "calib/report/verdict_text.h"
#include "calib/stats/probability.h"

namespace mgtd::calib::report {

using figures::escaped;

std::string candidates_section(const ReportContent& c) {
  if (c.drawn.candidates.empty()) return "";
  return "<h2>What could be missing</h2>" + figures_html(c.drawn.candidates) +
         html_good(
             "no candidate of any size. A name is a hypothesis about the cause; what is measured is that the "
             "residual "
             "behaves like it.");
}

std::string laws_section(const ReportContent& c) {
  if (c.laws.empty()) return "";
  std::string out = "<h2>Laws that are in no library</h2><p>" + escaped(c.laws_note) +
                    " A formula says what the readings depend on, never why.</p>";
  for (const LawPage& law : c.laws) {
    out += "<h3>" + escaped(law.title) + "</h3>" + figures::table_html(law.formulas, true);
    if (law.curve) out += figures_html({*law.curve});
    for (const std::string& note : law.notes) out += "<p class=\"quiet\">" + escaped(note) + "</p>";
  }
  return out + html_good("one formula with P near 1 that a second run confirms (mgt define --from).");
}

std::string rounds_section(const ReportContent& c) {
  std::string out = "<h2>The search, round by round</h2>";
  if (c.explained.rounds.empty())
    return out + fmt::format(
                     "<p>Nothing was added: of {} candidates none stood out from {:.3g} nT of residual.</p>",
                     c.explained.candidates.size(), c.explained.residual_nT);
  Rows rows;
  for (const criticism::search::Round& r : c.explained.rounds)
    rows.push_back({r.added.effect, r.added.where, size_text(r.added), fmt::format("{:.1f}", r.added.d),
                    stats::p_text(r.added.log10_p),
                    fmt::format("{:.3f} → {:.3f}", r.rms_before_nT, r.rms_after_nT),
                    fmt::format("{:.0f} of {:.0f}", r.chi2_before - r.chi2_after, r.added.fall),
                    fmt::format("{}", fmt::join(r.possible, ", "))});
  return out +
         html_table({"added", "where", "size", "d", "p", "residual, nT", "fall of chi-square, of predicted",
                     "could also be"},
                    rows, true) +
         html_good(fmt::format("the residual falls to the noise, {:.3g} nT, and chi-square falls by what was "
                               "predicted. Here it ends at "
                               "{:.3g} nT.",
                               c.explained.noise_nT, c.explained.rounds.back().rms_after_nT));
}

std::string waterfall_section(const ReportContent& c) {
  if (c.drawn.falls.empty()) return "";
  return "<h2>What each effect takes out</h2>" + figures_html(c.drawn.falls);
}

std::string limits_section(const ReportContent& c) {
  std::string out = "<h2>What this run cannot tell</h2>";
  Rows untestable;
  for (const criticism::tests::Untestable& u : c.explained.untestable)
    untestable.push_back({u.effect, u.why});
  out += fmt::format("<p>{} effects were tested, {} could not be.</p>", c.explained.candidates.size(),
                     untestable.size());
  out += html_table({"untestable", "why"}, untestable, true);
  for (const std::string& w : weak_texts(c.fit)) out += "<p class=\"quiet\">" + escaped(w) + "</p>";
  return out + figures_html(c.drawn.limits) +
         html_good(
             "sizes smaller than what your work can bear. An effect below its size may be there unseen.");
}

std::string next_section(const ReportContent& c) {
  std::string out = "<h2>What remains, and what to measure next</h2>";
  out += fmt::format("<p>After the last round: {}.</p>", to_string(c.explained.left));
  Rows next;
  for (const design::NextMeasurement& n : c.explained.next)
    next.push_back({n.action, fmt::format("{:.0f}", n.minutes), fmt::format("{:.3f}", n.p_right_before),
                    fmt::format("{:.3f}", n.p_right_after)});
  if (next.empty()) return out + "<p>No further measurement is asked for: there is no name to settle.</p>";
  return out + "<h3>What would settle the name</h3>" +
         html_table({"measurement", "minutes", "p right now", "p right then"}, next, true);
}

std::string figures_html(const std::vector<figures::Figure>& figures) {
  if (figures.empty()) return "";
  std::string out = "<div class=\"figures\">";
  for (const figures::Figure& f : figures) out += figures::figure_html(f);
  return out + "</div>";
}

std::string parameters_section(const ReportContent& c) {
  const int sensors = static_cast<int>(c.fit.calibration.sensors.size());
  std::vector<std::string> head{""};
  for (int s = 1; s <= sensors; ++s) head.push_back(fmt::format("s{}", s));
  Rows rows;
  for (int k = 0; k < sensor::kSensorParameters; ++k) {
    const bool scale = k >= sensor::cx && k <= sensor::cz, offset = k >= sensor::ix && k <= sensor::iz;
    std::vector<std::string> row{std::string(sensor::kParameterNames[static_cast<std::size_t>(k)]) +
                                 (scale    ? ""
                                  : offset ? ", nT"
                                           : ", deg")};
    for (int s = 0; s < sensors; ++s) {
      const int slot = s * sensor::kSensorParameters + k;
      double value = c.fit.calibration.sensors[static_cast<std::size_t>(s)].parameters()[k];
      double sd = std::sqrt(c.fit.calibration.covariance(slot, slot));
      if (!scale && !offset) value = to_deg(value), sd = to_deg(sd);
      row.push_back(with_sd(value, sd));
    }
    rows.push_back(std::move(row));
  }
  Rows effects;
  for (const calibration::CalibratedEffect& e : c.fit.calibration.effects) {
    for (const calibration::EffectCoefficient& x : e.coefficients)
      effects.push_back({e.effect, x.name, with_sd(x.value, x.sd) + " " + x.unit});
  }
  std::string out = "<h2>Parameters</h2>" + html_table(head, rows, false);
  if (!effects.empty())
    out += "<h3>Effects in the model</h3>" + html_table({"effect", "coefficient", ""}, effects, true);
  return out + "<p class=\"quiet\">" + escaped(c.fit.calibration.gauge) + "</p>" +
         figures_html(c.drawn.prices) + figures_html(c.drawn.earlier) +
         html_good(
             "scales and offsets as the sensors' certificates say, standard errors far below what matters.");
}

std::string judgements_section(const ReportContent& c) {
  if (c.file.judgements.rows.empty()) return {};
  return "<h2>How the run went on until it was explained</h2>" +
         figures::table_html(c.file.judgements, true) +
         html_good(
             "each step makes the right name more probable, and the last one is clear. All looks together "
             "declare the true name impossible in at most one run of 200.");
}

std::string history_section(const ReportContent& c) {
  if (c.file.history.rows.empty())
    return "<h2>How the model came to be</h2><p>The file keeps no steps of a model.</p>";
  return "<h2>How the model came to be</h2>" + figures::table_html(c.file.history, true);
}

}  // namespace mgtd::calib::report
