// SPDX-License-Identifier: Apache-2.0
#include "calib/report/validity_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "calib/report/change_report.h"
#include "calib/report/fit_report_json.h"
#include "calib/report/outlier_text.h"

namespace mgtd::calib::report {
namespace {

std::string conclusion_text(const validity::ValidityReport& r) {
  const validity::Change& c = r.change;
  const std::string figures = figures_text(c);
  if (r.changed()) {
    const auto best = std::max_element(c.others_log10_p.begin(), c.others_log10_p.end());
    const std::string where =
        *best > std::log10(validity::kChanged)
            ? fmt::format("sensor s{} alone would explain it", best - c.others_log10_p.begin() + 1)
            : std::string("more than one sensor");
    return fmt::format(
        "no longer valid ({}): {}{}; calibrate again", figures, where,
        c.named.empty() ? ", spread over many parameters" : ", accounted for by " + named_text(c));
  }
  if (!r.valid) {
    return fmt::format(
        "no longer valid: the poses scatter {:.1f} times more than the noise, and no change of the "
        "parameters explains "
        "it; a disturbance while they were measured, or an effect that is not in the model",
        r.excess);
  }
  return fmt::format("still valid ({})", figures);
}

}  // namespace

std::vector<std::string> validity_reasons(const validity::ValidityReport& r) {
  std::vector<std::string> out{conclusion_text(r)};
  if (r.own_poses)
    out.emplace_back(
        "these are the poses that the calibration was fitted to: they follow it in any case; measure others");
  out.push_back("smallest change that these poses show in 80 of 100 cases: " + seen_text(r.change));
  if (r.turn) out.push_back(turn_text(*r.turn));
  if (r.excess > 1 && r.valid) {
    out.push_back(
        fmt::format("the poses scatter {:.2f} times more than the noise; the test allows for it", r.excess));
  }
  if (!r.noise_from_dwells)
    out.emplace_back("the noise is that of the calibration's own run: the poses have no spreads or counts");
  for (const std::string& text : outlier_texts(r.outliers)) out.push_back(text + "; left out, measure again");
  return out;
}

nlohmann::json to_json(const validity::ValidityReport& r) {
  nlohmann::json outliers = nlohmann::json::array();
  for (const fit::OutlierNode& o : r.outliers)
    outliers.push_back({{"pose", o.pose}, {"where", o.where}, {"shift", o.shift}, {"unit", o.unit}});
  return {{"schema", "mgt.check/1"},
          {"calibration", r.calibration},
          {"poses", r.poses},
          {"valid", r.valid},
          {"reasons", validity_reasons(r)},
          {"change", to_json(r.change)},
          {"errors", to_json(r.errors)},
          {"residual_nT", r.residual_nT},
          {"noise_nT", r.noise_nT},
          {"excess", r.excess},
          {"outliers", std::move(outliers)}};
}

}  // namespace mgtd::calib::report
