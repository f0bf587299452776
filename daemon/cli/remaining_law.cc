// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/remaining_law.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "calib/discovery/discover.h"
#include "calib/report/discovery_report.h"
#include "daemon/cli/searched_model.h"
#include "daemon/cli/work_progress.h"

namespace mgtd::daemon::cli {

using calib::criticism::search::Finding;

RemainingLaw remaining_law(const PoseTable& table, const calib::fit::FitOptions& options, Finding left) {
  if (left != Finding::partial && left != Finding::unknown) return std::nullopt;
  return with_progress("discover", options, [&](const calib::fit::FitOptions& told) {
    return calib::discovery::discover(table, {.fit = told, .checks = false});
  });
}

nlohmann::json law_json(const RemainingLaw& law, const calib::fit::FitOptions& options,
                        const store::PoseSource& source, const std::string& run) {
  if (!law) return {};
  if (!*law) return {{"refused", law->error().message}, {"remedy", law->error().remedy}};
  return calib::report::to_json(**law, run, commands_to_model(options.effects, source, run));
}

std::string law_text(const RemainingLaw& law, const calib::fit::FitOptions& options,
                     const store::PoseSource& source, const std::string& run) {
  if (!law) return {};
  if (!*law) return fmt::format("\nNo formula was looked for: {}.\n", law->error().message);
  std::vector<std::string> model;
  for (const calib::effects::EffectPtr& effect : options.effects) model.push_back(effect->spec());
  const std::string beside =
      model.empty() ? std::string() : fmt::format(" beside {}", fmt::join(model, ", "));
  return fmt::format("\nA formula for what remains{} (mgt discover --quick):\n{}", beside,
                     calib::report::to_text(**law, run, commands_to_model(options.effects, source, run)));
}

}  // namespace mgtd::daemon::cli
