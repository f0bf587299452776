// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/second_look.h"

#include <algorithm>

#include "calib/criticism/search/narrow_model.h"
#include "calib/criticism/tests/scan_refinement.h"

namespace mgtd::calib::criticism::search {
namespace {

/// Of the variance before over that after: from here on a second look can tell more than the first.
constexpr double kMuchLess = 1.5;

}  // namespace

std::optional<SecondLook> second_look(const PoseTable& table, const fit::joint::JointOptions& narrow,
                                      const tests::Criticism& first, std::size_t winner,
                                      const std::vector<tests::Alternative>& alternatives,
                                      double noise_inflation, const fit::joint::JointFit& with,
                                      std::uint64_t seed, int looks) {
  const double after = std::max(1.0, with.chi2 / std::max(with.dof, 1.0));
  if (first.noise.reference.scale2 * noise_inflation * noise_inflation < kMuchLess * after)
    return std::nullopt;
  const auto at = narrow_model(table, narrow, with);
  if (!at) return std::nullopt;
  tests::Residual residual(at->problem, at->state, 0);
  residual.measure_by(after);
  const tests::NoiseReference noise{};
  std::vector<tests::ScoredFamily> families;
  for (std::size_t f = 0; f < first.families.size(); ++f) {
    const tests::ScoredFamily& known = first.families[f];
    const bool asked =
        std::any_of(alternatives.begin(), alternatives.end(), [&](const tests::Alternative& alternative) {
          return alternative.possible && alternative.effect == known.candidate_effect->name;
        });
    if (f != winner && !asked) continue;
    // What the first look added to the family was made for its own residual, but is as good a start here.
    tests::ScoredFamily again{.candidate_effect = known.candidate_effect, .own = known.own};
    for (const effects::EffectPtr& variant : known.candidate_effect->variants) {
      again.signatures.emplace_back(residual, tests::effect_source(at->problem, at->state, variant));
      again.score_last(noise);
    }
    if (!again.testable()) continue;
    again.asked = known.asked;
    again.calibrated = tests::best_of(std::min(0.0, again.priced), again.asked);
    tests::refine(at->problem, at->state, residual, noise, again);
    tests::refine_place(at->problem, at->state, residual, noise, again);
    families.push_back(std::move(again));
  }
  const auto best = std::min_element(families.begin(), families.end(), [](const auto& a, const auto& b) {
    return a.calibrated < b.calibrated;
  });
  const std::string& name = first.families[winner].candidate_effect->name;
  if (best == families.end()) return std::nullopt;
  if (best->candidate_effect->name != name)
    return SecondLook{.alternatives = {}, .better = best->candidate_effect->name};
  return SecondLook{.alternatives = tests::alternatives_of(
                        families, static_cast<std::size_t>(best - families.begin()), seed, looks),
                    .better = {}};
}

}  // namespace mgtd::calib::criticism::search
