// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/remaining_law.h"

#include <algorithm>
#include <span>
#include <utility>

namespace mgtd::calib::discovery {
namespace {

using Effects = std::vector<effects::EffectPtr>;

Result<DiscoveryReport> discover_beside(const PoseTable& table, DiscoverOptions options, Effects model) {
  options.fit.effects = std::move(model);
  return discover(table, options);
}

std::ptrdiff_t laws_of(const DiscoveryReport& report) {
  return std::count_if(report.laws.begin(), report.laws.end(),
                       [](const FoundLaw& law) { return law.stands_out; });
}

/// With one more effect in the model, formulas still account for everything, and there is one less of them.
bool takes_the_place_of_one(const Result<DiscoveryReport>& with, const DiscoveryReport& without) {
  if (!with) return false;
  if (with->finding == LawFinding::pass) return true;
  return with->accounts_for_everything() && laws_of(*with) < laws_of(without);
}

}  // namespace

std::optional<RemainingLaw> law_instead(const PoseTable& table, const DiscoverOptions& options,
                                        const Effects& described) {
  const Effects& given = options.fit.effects;
  if (described.size() <= given.size()) return std::nullopt;
  RemainingLaw out{.found = discover_beside(table, options, given), .model = given};
  if (!out.found || !out.found->accounts_for_everything()) return std::nullopt;
  for (const effects::EffectPtr& effect : std::span(described).subspan(given.size())) {
    Effects more = out.model;
    more.push_back(effect);
    auto with = discover_beside(table, options, more);
    if (takes_the_place_of_one(with, *out.found)) {
      out.found = std::move(with), out.model = std::move(more);
      if (!out.found->accounts_for_everything()) break;
    } else {
      out.instead_of.push_back(effect->spec());
    }
  }
  return out.instead_of.empty() ? std::nullopt : std::optional(std::move(out));
}

RemainingLaw remaining_law(const PoseTable& table, const DiscoverOptions& options, const Effects& described) {
  if (auto instead = law_instead(table, options, described)) return *std::move(instead);
  return {.found = discover_beside(table, options, described), .model = described};
}

}  // namespace mgtd::calib::discovery
