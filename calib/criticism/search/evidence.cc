// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/evidence.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "calib/criticism/search/effect_search.h"
#include "calib/criticism/tests/alternatives.h"
#include "calib/criticism/tests/judgement.h"
#include "calib/criticism/tests/multiplicity.h"
#include "calib/effects/library/effect_family.h"
#include "calib/fit/joint/joint_report.h"

namespace mgtd::calib::criticism::search {
namespace {

/// The family called so, or why there is none.
Result<std::size_t> family_asked(const tests::Criticism& c, const std::vector<tests::Untestable>& untestable,
                                 const std::string& name) {
  for (std::size_t f = 0; f < c.families.size(); ++f)
    if (c.families[f].candidate_effect->name == name) return f;
  for (const auto* list : {&untestable, &c.untestable}) {
    for (const tests::Untestable& u : *list) {
      if (u.effect != name) continue;
      const effects::library::EffectFamily* const family = effects::library::find_family(name);
      return fail(ErrorCode::refused, fmt::format("{} cannot be tested on this run: {}", name, u.why),
                  family != nullptr && !family->experiment.empty() ? std::string(family->experiment)
                                                                   : "mgt effects " + name);
    }
  }
  return fail(ErrorCode::usage, effects::library::no_such_effect(name),
              "mgt effects lists those of the library, mgt model the formulas of a run file");
}

/// Makes the best question at a place the one that is asked; it alone counts then.
Result<void> ask_at(const std::string& where, tests::ScoredFamily& family) {
  std::optional<std::size_t> best;
  std::set<std::string> places;
  for (std::size_t i = 0; i < family.scores.size(); ++i) {
    const tests::Score& score = family.scores[i];
    const std::string& place = family.candidate_effect->hypotheses[score.hypothesis].where;
    places.insert(place);
    if (place == where && (!best || score.S > family.scores[*best].S)) best = i;
  }
  if (!best) {
    return fail(ErrorCode::usage,
                fmt::format("{} cannot be tested at '{}' on this run", family.candidate_effect->name, where),
                fmt::format("it can at {}", fmt::join(places, ", ")));
  }
  family.best = *best;
  family.calibrated = std::min(0.0, family.winner().log10_p);
  return {};
}

Result<Left> left_of(const fit::joint::JointFit& fit, const tests::Criticism& c, double table_sd_rad,
                     bool by_pose) {
  Left out{.residual_nT = residual_of(fit),
           .noise_nT = fit.noise_nT(),
           .chi2 = tests::chi2_at_stated_noise(fit, c, table_sd_rad),
           .dof = c.dof,
           .maps = c.maps,
           .fit = std::make_shared<const fit::joint::JointFit>(fit)};
  if (!by_pose) return out;
  auto found = tests::residual_columns(*out.fit);
  if (!found) return tl::unexpected(found.error());
  out.by_pose = *std::move(found);
  return out;
}

/// What the fit with the effect leaves.
Result<Left> left_with(const PoseTable& table, fit::FitOptions options, const tests::ScoredFamily& family,
                       double table_sd_rad, bool by_pose) {
  const tests::CandidateEffect& candidate = *family.candidate_effect;
  const std::size_t variant = family.winner().variant;
  auto effect = candidate.make && !candidate.dipole_at
                    ? candidate.make(&family.where(), candidate.values[variant])
                    : Result<effects::EffectPtr>(candidate.variants[variant]);
  if (!effect) return tl::unexpected(effect.error());
  options.effects.push_back(*std::move(effect));
  const auto joint = fit::joint::profiled_options(table, options);
  if (!joint) return tl::unexpected(joint.error());
  const auto fit = fit::joint::fit_joint_at_size(table, *joint);
  if (!fit) return tl::unexpected(fit.error());
  tests::Criticism c = tests::criticise(*fit, tests::CandidateEffects{}, options.seed);
  tests::look_at_maps(c);
  return left_of(*fit, c, table_sd_rad, by_pose);
}

std::vector<Evidence::Tell> tells_of(const std::string& name) {
  std::vector<Evidence::Tell> out;
  const effects::library::EffectFamily* const family = effects::library::find_family(name);
  if (family == nullptr) return out;
  for (const effects::library::Confusion& confusion : family->confusions)
    out.push_back({std::string(confusion.with), std::string(confusion.broken_by)});
  return out;
}

}  // namespace

Result<Evidence> evidence_of(const PoseTable& table, const ExplainOptions& options, const std::string& effect,
                             const std::string& at, bool by_pose) {
  const std::string name(effects::family_name(effect));
  Evidence out;
  fit::FitOptions without = options.fit;
  out.in_model =
      std::erase_if(without.effects, [&](const effects::EffectPtr& e) { return e->name() == name; }) > 0;
  const auto joint = fit::joint::profiled_options(table, without);
  if (!joint) return tl::unexpected(joint.error());
  tests::CandidateEffects candidates = tests::library_candidates(table);
  candidates.testable.insert(candidates.testable.end(), options.also.begin(), options.also.end());
  const auto fit = fit::joint::fit_joint_at_size(table, *joint);
  if (!fit) return tl::unexpected(fit.error());
  tests::Judgement judged = tests::judge(*fit, candidates, without.seed);
  tests::Criticism& c = judged.criticism;
  if (c.maps.empty()) tests::look_at_maps(c);
  const auto f = family_asked(c, candidates.untestable, name);
  if (!f) return tl::unexpected(f.error());
  tests::ScoredFamily& family = c.families[*f];
  if (!at.empty())
    if (const auto asked = ask_at(at, family); !asked) return tl::unexpected(asked.error());
  out.candidate = tests::candidate_of(family, c, judged.fit.noise_inflation);
  out.candidate.alternatives = tests::alternatives_of(c.families, *f, without.seed);
  tests::weigh_poses(judged.fit, c.evidence_by_pose(*f), out.candidate);
  const tests::Signature& signature = family.signatures[family.winner().variant];
  out.added = tests::added_variable(signature, tests::one_step(signature, family.where()), c.residual,
                                    judged.fit.problem);
  out.candidate.impact = tests::impact_of(judged.fit, family);
  out.tells = tells_of(name);
  const double table_sd_rad = judged.fit.table_sd_rad;
  auto before = left_of(judged.fit, c, table_sd_rad, by_pose);
  if (!before) return tl::unexpected(before.error());
  auto after = left_with(table, without, family, table_sd_rad, by_pose);
  if (!after) return tl::unexpected(after.error());
  out.before = *std::move(before);
  out.after = *std::move(after);
  return out;
}

}  // namespace mgtd::calib::criticism::search
