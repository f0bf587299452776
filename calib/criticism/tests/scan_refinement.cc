// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/scan_refinement.h"

#include <algorithm>

#include "calib/criticism/tests/dipole_search.h"
#include "calib/criticism/tests/multiplicity.h"

namespace mgtd::calib::criticism::tests {
namespace {

constexpr int kHalvings = 4;

/// The value next to that of the winner, below or above; empty at the end.
std::optional<double> neighbour(const CandidateEffect& candidate_effect, double value, bool above) {
  std::optional<double> out;
  for (const auto& other : candidate_effect.values) {
    if (!other || (above ? *other <= value : *other >= value)) continue;
    if (!out || (above ? *other < *out : *other > *out)) out = other;
  }
  return out;
}

/// Gives the family a candidate of its own, to which more variants may be added.
CandidateEffect& widened(ScoredFamily& family) {
  const auto wider = std::make_shared<CandidateEffect>(*family.candidate_effect);
  family.own = wider;
  family.candidate_effect = wider.get();
  return *wider;
}

void add_variant(const std::optional<double>& value, effects::EffectPtr effect, Signature signature,
                 const NoiseReference& noise, CandidateEffect& wider, ScoredFamily& family) {
  wider.values.push_back(value);
  wider.variants.push_back(std::move(effect));
  family.signatures.push_back(std::move(signature));
  family.score_last(noise);
}

}  // namespace

void refine(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
            const Residual& residual, const NoiseReference& noise, ScoredFamily& family) {
  if (!family.candidate_effect->between || !family.candidate_effect->values[family.winner().variant]) return;
  CandidateEffect& wider = widened(family);
  for (int i = 0; i < kHalvings; ++i) {
    const double value = *wider.values[family.winner().variant];
    for (const bool above : {false, true}) {
      const auto end = neighbour(wider, value, above);
      const auto tried = end ? wider.between(std::min(value, *end), std::max(value, *end)) : std::nullopt;
      auto effect = tried ? wider.make(nullptr, tried) : Result<effects::EffectPtr>(nullptr);
      if (!effect || *effect == nullptr) continue;
      Signature signature(residual, effect_source(problem, state, *effect));
      add_variant(tried, *std::move(effect), std::move(signature), noise, wider, family);
    }
  }
  family.calibrated = best_of(std::min(0.0, family.priced), family.asked);
}

void try_every_instant(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
                       const Residual& residual, const NoiseReference& noise, ScoredFamily& family) {
  constexpr std::size_t kMost = 1000;
  const std::vector<double> instants = family.candidate_effect->instants;
  if (instants.size() > kMost) return;
  CandidateEffect& wider = widened(family);
  const std::size_t before = wider.variants.size();
  for (const double instant : instants) {
    if (std::find(wider.values.begin(), wider.values.end(), instant) != wider.values.end()) continue;
    auto effect = wider.make(nullptr, instant);
    if (!effect || *effect == nullptr) continue;
    Signature signature(residual, effect_source(problem, state, *effect));
    add_variant(instant, *std::move(effect), std::move(signature), noise, wider, family);
  }
  family.asked *= static_cast<double>(wider.variants.size()) / static_cast<double>(before);
  family.calibrated = best_of(std::min(0.0, family.priced), family.asked);
}

void refine_place(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
                  const Residual& residual, const NoiseReference& noise, ScoredFamily& family) {
  if (!family.candidate_effect->dipole_at) return;
  CandidateEffect& wider = widened(family);
  const std::optional<double> value = wider.values[family.winner().variant];
  auto found = find_dipole(problem, state, residual, [&](const Eigen::Vector3d& place_S_m) {
    return wider.dipole_at(place_S_m, value);
  });
  if (!found) return;
  if (found->signature.cols() != wider.hypotheses.front().combine.rows())
    wider.hypotheses.push_back(hypotheses_of(*found->effect, problem.sensors()).front());
  add_variant(value, found->effect, std::move(found->signature), noise, wider, family);
  family.calibrated = best_of(std::min(0.0, family.priced), family.asked);
}

void put_at_place(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
                  const Residual& residual, const NoiseReference& noise, const effects::EffectPtr& dipole,
                  ScoredFamily& family) {
  CandidateEffect& wider = widened(family);
  add_variant(wider.values[family.winner().variant], dipole,
              Signature(residual, effect_source(problem, state, dipole)), noise, wider, family);
  const std::size_t last = family.signatures.size() - 1;
  for (std::size_t i = 0; i < family.scores.size(); ++i)
    if (family.scores[i].variant == last) family.best = i;
  family.calibrated = best_of(std::min(0.0, family.priced), family.asked);
}

}  // namespace mgtd::calib::criticism::tests
