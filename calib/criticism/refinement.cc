// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/refinement.h"

#include <algorithm>

#include "calib/criticism/null.h"

namespace mgtd::calib {
namespace {

constexpr int kHalvings = 4;

/// The value next to that of the winner, below or above; empty at the end.
std::optional<double> neighbour(const Suspect& suspect, double value, bool above) {
  std::optional<double> out;
  for (const auto& other : suspect.values) {
    if (!other || (above ? *other <= value : *other >= value)) continue;
    if (!out || (above ? *other < *out : *other > *out)) out = other;
  }
  return out;
}

}  // namespace

void refine(const JointProblem& problem, const JointState& state, const Residual& residual,
            const NoiseReference& noise, ScoredFamily& family) {
  if (!family.suspect->between || !family.suspect->values[family.winner().variant]) return;
  const auto wider = std::make_shared<Suspect>(*family.suspect);
  family.own = wider;
  family.suspect = wider.get();
  for (int i = 0; i < kHalvings; ++i) {
    const double value = *wider->values[family.winner().variant];
    for (const bool above : {false, true}) {
      const auto end = neighbour(*wider, value, above);
      const auto tried = end ? wider->between(std::min(value, *end), std::max(value, *end)) : std::nullopt;
      auto effect = tried ? wider->make(nullptr, tried) : Result<EffectPtr>(nullptr);
      if (!effect || *effect == nullptr) continue;
      wider->values.push_back(tried);
      wider->variants.push_back(*std::move(effect));
      family.signatures.push_back(
          signature_of(residual, effect_rows(problem, state, wider->variants.back())));
      family.score_last(noise);
    }
  }
  family.calibrated = best_of(std::min(0.0, family.priced), family.asked);
}

}  // namespace mgtd::calib
