// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/law_hypotheses.h"

#include <string>
#include <utility>

#include "calib/effects/library/library.h"

namespace mgtd::daemon::run {

std::vector<calib::design::Hypothesis> hypotheses_of(const calib::discovery::FoundLaw& law, int sensors) {
  std::vector<calib::design::Hypothesis> out;
  for (const calib::discovery::FoundFormula& formula : law.formulas) {
    if (out.size() == kMostHypotheses) break;
    std::vector<std::string> specs = formula.specs;
    if (specs.empty() && !formula.library.empty() && formula.columns.empty())
      specs = {formula.library + "@" + formula.where};
    if (specs.empty() || !calib::effects::library::make_effect(specs.front(), sensors)) continue;
    out.push_back(
        {.name = formula.formula + " at " + formula.where, .specs = std::move(specs), .P = formula.P});
  }
  if (out.size() < 2) out.clear();
  return out;
}

void add_laws_beside(const calib::discovery::DiscoveryReport& found, std::size_t asked, int sensors,
                     calib::fit::FitOptions& options) {
  for (std::size_t i = 0; i < found.laws.size(); ++i) {
    if (i == asked || found.laws[i].d < found.laws[asked].d) continue;
    for (const std::string& spec : found.laws[i].formulas.front().specs)
      if (auto effect = calib::effects::library::make_effect(spec, sensors))
        options.effects.push_back(*std::move(effect));
  }
}

}  // namespace mgtd::daemon::run
