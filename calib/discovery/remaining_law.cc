// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/remaining_law.h"

#include <algorithm>
#include <utility>

#include "calib/effects/added_effects.h"
#include "calib/effects/effect_spec.h"
#include "calib/effects/library/effect_family.h"

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

/// One of the laws is that effect, as far as evidence can tell.
bool is_a_law(const effects::Effect& effect, const DiscoveryReport& report) {
  const auto spec = effects::EffectSpec::parse(effect.spec());
  if (!spec) return false;
  return std::any_of(report.laws.begin(), report.laws.end(), [&](const FoundLaw& law) {
    return std::any_of(law.as_well.begin(), law.as_well.end(), [&](const LibraryEffect& as_well) {
      return as_well.name == spec->name && (!spec->where || as_well.where == spec->where->text());
    });
  });
}

/// Whether the evidence of laws can be held against that of an effect: the search has no places of dipoles,
/// no instants of steps and no formulas of a user's own in its library.
bool can_be_compared(const effects::Effect& effect) {
  const std::string_view name = effect.name();
  return effects::library::find_family(name) != nullptr && name != "site.dipole" && name != "site.step";
}

}  // namespace

std::optional<RemainingLaw> law_instead(const PoseTable& table, const DiscoverOptions& options,
                                        const Effects& described) {
  const Effects& given = options.fit.effects;
  const Effects named = effects::added_effects(described, given);
  if (named.empty() || named.size() + given.size() != described.size()) return std::nullopt;
  RemainingLaw out{.found = discover_beside(table, options, given), .model = given};
  if (!out.found || !out.found->accounts_for_everything()) return std::nullopt;
  for (const effects::EffectPtr& effect : named) {
    if (!can_be_compared(*effect) || is_a_law(*effect, *out.found)) {
      Effects more = out.model;
      more.push_back(effect);
      auto with = discover_beside(table, options, more);
      // Nothing is left: then what else was found is not needed, and no formula says so.
      if (!with || with->finding == LawFinding::pass) return std::nullopt;
      if (with->accounts_for_everything() && laws_of(*with) < laws_of(*out.found)) {
        out.found = std::move(with), out.model = std::move(more);
        continue;
      }
    }
    out.instead_of.push_back(effect->spec());
  }
  return out;
}

RemainingLaw remaining_law(const PoseTable& table, const DiscoverOptions& options, const Effects& described) {
  if (auto instead = law_instead(table, options, described)) return *std::move(instead);
  return {.found = discover_beside(table, options, described), .model = described};
}

}  // namespace mgtd::calib::discovery
