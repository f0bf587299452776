// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/price_figures.h"

#include <string>
#include <utility>

#include "calib/fit/joint/effect_impact.h"
#include "calib/report/explain_figures.h"

namespace mgtd::daemon::cli {

std::vector<calib::report::figures::Figure> price_figures(const PoseTable& table,
                                                          const calib::criticism::search::ModelStage& stage) {
  std::vector<calib::report::figures::Figure> out;
  const auto narrow = calib::criticism::search::fit_under_same_weights(table, stage, {});
  if (!narrow) return out;
  out.push_back(calib::report::price_of(*narrow, stage.fit));
  std::vector<std::pair<std::string, calib::fit::joint::EffectImpact>> impacts;
  Eigen::Index first = 0;
  for (const calib::effects::EffectPtr& effect : stage.options.effects) {
    const auto n = static_cast<Eigen::Index>(effect->coefficients().size());
    if (const auto impact =
            calib::fit::joint::effect_impact(*narrow, effect, stage.fit.state.coefficients.segment(first, n)))
      impacts.emplace_back(effect->spec(), *impact);
    first += n;
  }
  if (!impacts.empty()) out.push_back(calib::report::impact_of(impacts, *narrow));
  return out;
}

}  // namespace mgtd::daemon::cli
