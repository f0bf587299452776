// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/remaining_law.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "calib/discovery/discover.h"
#include "calib/report/discovery_report.h"
#include "daemon/cli/searched_model.h"
#include "daemon/cli/work_progress.h"

namespace mgtd::daemon::cli {

using calib::criticism::search::Finding;

namespace {

std::vector<std::string> specs_of(const std::vector<calib::effects::EffectPtr>& effects) {
  std::vector<std::string> out;
  for (const calib::effects::EffectPtr& effect : effects) out.push_back(effect->spec());
  return out;
}

/// What the search has added to a model: it keeps what was there, in its order.
std::vector<std::string> added(const std::vector<calib::effects::EffectPtr>& described,
                               const std::vector<calib::effects::EffectPtr>& asked) {
  const std::vector<std::string> all = specs_of(described);
  const std::size_t kept = std::min(asked.size(), all.size());
  return {all.begin() + static_cast<std::ptrdiff_t>(kept), all.end()};
}

}  // namespace

std::optional<RemainingLaw> remaining_law(const PoseTable& table, const calib::fit::FitOptions& options,
                                          const std::vector<calib::effects::EffectPtr>& described,
                                          Finding left) {
  if (left != Finding::partial && left != Finding::unknown) return std::nullopt;
  const auto search = [&](const std::vector<calib::effects::EffectPtr>& model) {
    calib::fit::FitOptions beside = options;
    beside.effects = model;
    return with_progress("discover", beside, [&](const calib::fit::FitOptions& told) {
      return calib::discovery::discover(table, {.fit = told, .checks = false});
    });
  };
  std::vector<std::string> named = added(described, options.effects);
  if (!named.empty())
    if (auto alone = search(options.effects); alone && alone->accounts_for_everything())
      return RemainingLaw{
          .found = std::move(alone), .model = options.effects, .instead_of = std::move(named)};
  return RemainingLaw{.found = search(described), .model = described};
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
  const std::string heading =
      !law->instead_of.empty()
          ? fmt::format("A formula for everything, instead of {}", fmt::join(law->instead_of, ", "))
      : law->model.empty()
          ? "A formula for what remains"
          : fmt::format("A formula for what remains beside {}", fmt::join(specs_of(law->model), ", "));
  return fmt::format("\n{} (mgt discover --quick):\n{}", heading,
                     calib::report::to_text(*law->found, run, commands_to_model(law->model, source, run)));
}

}  // namespace mgtd::daemon::cli
