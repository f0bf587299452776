// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/remaining_law.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "calib/discovery/remaining_law.h"
#include "calib/report/discovery_report.h"
#include "daemon/cli/searched_model.h"
#include "daemon/cli/work_progress.h"

namespace mgtd::daemon::cli {

using calib::criticism::search::Finding;
using calib::discovery::RemainingLaw;

namespace {

std::string heading(const RemainingLaw& law) {
  const std::string beside =
      law.model.empty() ? ""
                        : fmt::format(" beside {}", fmt::join(calib::effects::specs_of(law.model), ", "));
  if (law.instead_of.empty()) return "A formula for what remains" + beside;
  return fmt::format("A formula for everything{}, instead of {}", beside, fmt::join(law.instead_of, ", "));
}

}  // namespace

std::optional<RemainingLaw> law_of_the_rest(const PoseTable& table, const calib::fit::FitOptions& options,
                                            const std::vector<calib::effects::EffectPtr>& described,
                                            Finding left) {
  if (left != Finding::partial && left != Finding::unknown) return std::nullopt;
  return with_progress("discover", options, [&](const calib::fit::FitOptions& with_listener) {
    return calib::discovery::remaining_law(table, {.fit = with_listener, .checks = false}, described);
  });
}

nlohmann::json law_json(const std::optional<RemainingLaw>& law, const store::PoseSource& source,
                        const std::string& run) {
  if (!law) return {};
  if (!law->found) return {{"refused", law->found.error().message}, {"remedy", law->found.error().remedy}};
  nlohmann::json out = calib::report::to_json(*law->found, run, commands_to_model(law->model, source, run));
  out["instead_of"] = law->instead_of;
  return out;
}

std::string law_text(const std::optional<RemainingLaw>& law, const store::PoseSource& source,
                     const std::string& run) {
  if (!law) return {};
  if (!law->found) return fmt::format("\nNo formula was looked for: {}.\n", law->found.error().message);
  return fmt::format("\n{} (mgt discover --quick):\n{}", heading(*law),
                     calib::report::to_text(*law->found, run, commands_to_model(law->model, source, run)));
}

}  // namespace mgtd::daemon::cli
