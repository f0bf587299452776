// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/step_of_a_source.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "calib/criticism/tests/candidate_effect.h"
#include "calib/criticism/tests/dipole_search.h"
#include "calib/criticism/tests/residual.h"
#include "calib/effects/library/effect_family.h"
#include "calib/fit/joint/joint_fit.h"

namespace mgtd::calib::criticism::search {
namespace {

/// Fall of chi-square that a place must bring beyond the step without one: the moment of a dipole and its
/// place are no more numbers than a field and a gradient.
constexpr double kClearlyLess = 12;
/// Gaps between poses on either side of the moment that the step without a place found.
constexpr std::ptrdiff_t kGapsTried = 3;

/// When a step of the site that has no place came, in hours.
std::optional<double> moment_of(const effects::Effect& effect) {
  const auto spec = effects::EffectSpec::parse(effect.spec());
  if (!spec || spec->name != "site.step" || spec->find("x") != nullptr) return std::nullopt;
  const auto ts = spec->number("ts", 0, 0, 1e9);
  return ts ? std::optional(*ts) : std::nullopt;
}

std::vector<double> moments_near(double ts_h, const PoseTable& table) {
  const std::vector<double> gaps = effects::library::run_gaps_h({.table = &table, .offset_nT = {}});
  const auto at = std::lower_bound(gaps.begin(), gaps.end(), ts_h);
  const auto first = at - std::min(kGapsTried, at - gaps.begin()),
             last = at + std::min(kGapsTried + 1, gaps.end() - at);
  return {first, last};
}

double fall_with(const tests::Signature& signature) {
  const Eigen::Index n = signature.cols();
  const tests::OneStep step =
      tests::one_step(signature, tests::Hypothesis{.combine = Eigen::MatrixXd::Identity(n, n), .names = {}});
  return (step.basis.transpose() * signature.by_residual()).squaredNorm();
}

/// The dipole and its moment that take away most; null where none takes anything.
effects::EffectPtr best_source(const PoseTable& table, const fit::joint::JointFit& fit, double ts_h) {
  const tests::CandidateEffects all = tests::library_candidates(table);
  const auto step = std::find_if(all.testable.begin(), all.testable.end(),
                                 [](const tests::CandidateEffect& c) { return c.name == "site.step"; });
  if (step == all.testable.end()) return nullptr;
  const tests::Residual residual(fit.problem, fit.state, 0);
  effects::EffectPtr best;
  double most = 0;
  for (const double moment_h : moments_near(ts_h, table)) {
    const auto found = tests::find_dipole(
        fit.problem, fit.state, residual,
        [&](const Eigen::Vector3d& place_S_m) { return step->dipole_at(place_S_m, moment_h); });
    if (!found) continue;
    if (const double own = fall_with(found->signature); own > most) most = own, best = found->effect;
  }
  return best;
}

}  // namespace

std::optional<ModelStage> step_of_a_source(const PoseTable& table, const fit::FitOptions& options,
                                           const ModelStage& before, const ModelStage& with) {
  const auto ts_h = moment_of(*with.options.effects.back());
  if (!ts_h) return std::nullopt;
  const auto fit = fit::joint::fit_joint_at_size(table, before.options);
  if (!fit) return std::nullopt;
  const effects::EffectPtr source = best_source(table, *fit, *ts_h);
  if (source == nullptr) return std::nullopt;
  fit::FitOptions placed = options;
  placed.effects = with.options.effects;
  placed.effects.back() = source;
  auto out = model_stage(table, placed);
  if (!out) return std::nullopt;
  const auto same = fit_under_same_weights(table, *out, with.fit.problem.effects);
  const double needed = kClearlyLess * out->fit.birge_ratio * out->fit.birge_ratio;
  if (!same || same->chi2 < out->fit.chi2 + needed) return std::nullopt;
  return *std::move(out);
}

}  // namespace mgtd::calib::criticism::search
