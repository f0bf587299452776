// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/remaining_law.h"

#include <algorithm>
#include <span>
#include <utility>

#include "calib/effects/effect_spec.h"

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

/// With more effects in the model, formulas still account for everything, and there are fewer of them.
bool takes_the_place_of_some(const Result<DiscoveryReport>& with, const DiscoveryReport& without) {
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
  Effects more = given, stand_ins;
  for (const effects::EffectPtr& effect : std::span(described).subspan(given.size()))
    (is_a_law(*effect, *out.found) ? more : stand_ins).push_back(effect);
  if (more.size() > given.size()) {
    if (auto with = discover_beside(table, options, more); takes_the_place_of_some(with, *out.found))
      out.found = std::move(with), out.model = std::move(more);
    else
      stand_ins.assign(described.begin() + static_cast<std::ptrdiff_t>(given.size()), described.end());
  }
  for (const effects::EffectPtr& effect : stand_ins) out.instead_of.push_back(effect->spec());
  return out.instead_of.empty() ? std::nullopt : std::optional(std::move(out));
}

RemainingLaw remaining_law(const PoseTable& table, const DiscoverOptions& options, const Effects& described) {
  if (auto instead = law_instead(table, options, described)) return *std::move(instead);
  return {.found = discover_beside(table, options, described), .model = described};
}

}  // namespace mgtd::calib::discovery
