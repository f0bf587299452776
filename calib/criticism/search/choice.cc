// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/choice.h"

#include <algorithm>
#include <cmath>

#include "calib/criticism/search/explain.h"
#include "calib/effects/library/library.h"
#include "calib/fit/joint/joint_report.h"
#include "calib/poses/pose_table.h"

namespace mgtd::calib::criticism::search {
namespace {

const double kExcluded = 2 * std::log(1000);

/// A family where another one acts, its number left open; where it usually acts when it cannot act there.
std::string spec_of(const std::string& family, const std::string& where) {
  const std::string there = family + "@" + where;
  return effects::library::make_effect(there, kMostSensors) ? there : family;
}

/// Everything that could stand in the place of `effect`, where a round of the search found it or one of its
/// alternatives.
std::vector<std::string> alternatives_of(const ExplainReport& before, const std::string& effect) {
  for (const Round& round : before.rounds) {
    std::vector<std::string> names = round.possible;
    names.insert(names.begin(), round.added.effect);
    const auto own = std::find(names.begin(), names.end(), effect);
    if (own == names.end()) continue;
    names.erase(own);
    if (round.possible.empty()) return {};
    for (std::string& name : names) name = spec_of(name, round.added.where);
    return names;
  }
  return {};
}

bool named(const ExplainReport& before, const std::string& effect) {
  return std::find(before.named.begin(), before.named.end(), effect) != before.named.end();
}

/// dof ln(chi-square per degree of freedom, nT2) of a model: comparable also where the weights are estimated.
std::optional<double> misfit(const PoseTable& table, const fit::FitOptions& options) {
  const auto joint = fit::joint::profiled_options(table, options);
  if (!joint) return std::nullopt;
  const auto fit = fit::joint::fit_joint_at_size(table, *joint);
  if (!fit || !(fit->dof > 0)) return std::nullopt;
  return fit->dof * std::log(std::pow(fit->noise_nT(), 2) * fit->chi2 / fit->dof);
}

/// The model with `spec` in the place of the effect called `name`.
std::optional<fit::FitOptions> exchanged(const fit::FitOptions& options, const std::string& name,
                                         const std::string& spec) {
  auto alternative = effects::library::make_effect(spec, static_cast<int>(options.geometry.sensors()));
  if (!alternative) return std::nullopt;
  fit::FitOptions out = options;
  for (effects::EffectPtr& effect : out.effects)
    if (effect->name() == name) effect = *alternative;
  return out;
}

}  // namespace

Choice choice_of(const ExplainReport& before, const PoseTable& table, const effects::EffectPtr& effect) {
  const std::string name(effect->name());
  Choice out{.spec = effect->spec(),
             .finding = std::string(to_string(before.finding)),
             .alternatives = alternatives_of(before, name),
             .data = poses::data_hash(table)};
  const bool something = before.finding != Finding::pass && before.finding != Finding::bad_data;
  const bool whole = before.finding == Finding::explained || before.finding == Finding::ambiguous;
  out.describes = something && !(whole && named(before, name));
  return out;
}

Choice on_these_poses(Choice choice, const PoseTable& table, const fit::FitOptions& options) {
  if (choice.data == poses::data_hash(table)) return choice;
  if (choice.describes) {
    const auto now = explain(table, {.fit = options});
    choice.describes = !now || now->finding != Finding::pass;
  }
  const auto own = effects::EffectSpec::parse(choice.spec);
  const auto chosen = choice.alternatives.empty() || !own ? std::nullopt : misfit(table, options);
  if (!chosen) return choice;
  std::erase_if(choice.alternatives, [&](const std::string& alternative) {
    const auto model = exchanged(options, own->name, alternative);
    const auto other = model ? misfit(table, *model) : std::nullopt;
    return other && *other - *chosen > kExcluded;
  });
  return choice;
}

}  // namespace mgtd::calib::criticism::search
