// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/forward_step.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace mgtd::calib::criticism::search {
namespace {

/// Whether coefficients laid out as `whole` can be those laid out as `part`.
bool holds(const effects::Where& whole, const effects::Where& part) {
  if (whole == part || whole.scale == effects::Where::Scale::each_axis) return true;
  return whole.scale == effects::Where::Scale::each_sensor &&
         (part.scale == effects::Where::Scale::sensor || part.scale == effects::Where::Scale::all);
}

bool holds(const effects::Effect& whole, const effects::Effect& part) {
  if (whole.name() != part.name()) return false;
  const auto a = effects::EffectSpec::parse(whole.spec()), b = effects::EffectSpec::parse(part.spec());
  if (!a || !b || a->parameters != b->parameters) return false;
  if (!a->where) return whole.level() != effects::Level::axis;
  return b->where && holds(*a->where, *b->where);
}

/// The axis "s3.z" of a law is in the model with a number of its own.
bool has_axis(const std::vector<effects::EffectPtr>& model, const tests::ScoredFamily& winner,
              const std::string& axis) {
  if (winner.candidate_effect->parameter.empty()) return false;
  return std::any_of(model.begin(), model.end(), [&](const effects::EffectPtr& effect) {
    if (effect->name() != winner.candidate_effect->name) return false;
    const auto& all = effect->coefficients();
    return std::any_of(all.begin(), all.end(), [&](const effects::Coefficient& c) { return c.name == axis; });
  });
}

struct Pick {
  std::size_t hypothesis{0}, variant{0};
  double S{0};
  Eigen::VectorXd direction{};  ///< unit length, the others taken out
};

/// The one axis and number with the largest score once `picked` are taken out.
Pick next_pick(const tests::ScoredFamily& winner, const std::vector<effects::EffectPtr>& model,
               const tests::Residual& residual, const std::vector<Pick>& picked) {
  constexpr double kOwn = 1e-6;  // of a squared length: less is what the others hold already
  Pick best;
  for (std::size_t h = 0; h < winner.candidate_effect->hypotheses.size(); ++h) {
    const tests::Hypothesis& axis = winner.candidate_effect->hypotheses[h];
    if (axis.axes != 1 || axis.combine.cols() != 1 || has_axis(model, winner, axis.where)) continue;
    if (std::any_of(picked.begin(), picked.end(), [h](const Pick& p) { return p.hypothesis == h; })) continue;
    for (std::size_t v = 0; v < winner.signatures.size(); ++v) {
      Eigen::VectorXd z = winner.signatures[v].columns * axis.combine.col(0);
      const double whole = z.squaredNorm();
      for (const Pick& p : picked) z -= p.direction.dot(z) * p.direction;
      const double own = z.squaredNorm();
      if (!(own > kOwn * whole)) continue;
      z /= std::sqrt(own);
      const double S = std::pow(z.dot(residual.value()), 2);
      if (S > best.S) best = {.hypothesis = h, .variant = v, .S = S, .direction = std::move(z)};
    }
  }
  return best;
}

/// The few axes that make up the winner; empty where they are many or do not.
std::vector<Pick> few_axes(const tests::ScoredFamily& winner, const std::vector<effects::EffectPtr>& model,
                           const tests::Residual& residual) {
  constexpr double kStandsOut = 20, kWorthwhile = 0.01;  // of the largest
  constexpr std::size_t kFew = 4;
  constexpr double kMost = 0.8;  // of the winner's score
  std::vector<Pick> picked;
  double sum = 0;
  while (picked.size() <= kFew) {
    Pick next = next_pick(winner, model, residual, picked);
    if (next.S < kStandsOut || (!picked.empty() && next.S < kWorthwhile * picked.front().S)) break;
    sum += next.S;
    picked.push_back(std::move(next));
  }
  if (picked.size() > kFew || sum < kMost * winner.winner().S) picked.clear();
  return picked;
}

}  // namespace

Result<ForwardStep> forward_step(const std::vector<effects::EffectPtr>& model,
                                 const tests::ScoredFamily& winner, const tests::Residual& residual) {
  ForwardStep out;
  const tests::CandidateEffect& candidate_effect = *winner.candidate_effect;
  const bool one_axis = winner.where().axes == 1;
  std::vector<Pick> picked;
  if (winner.candidate_effect->level == effects::Level::axis && !one_axis)
    picked = few_axes(winner, model, residual);
  if (picked.empty()) {
    if (one_axis && has_axis(model, winner, winner.where().where)) {
      return fail(ErrorCode::refused,
                  winner.candidate_effect->name + " of " + winner.where().where + " is in the model already");
    }
    const std::size_t variant = winner.winner().variant;
    auto added = candidate_effect.dipole_at
                     ? Result<effects::EffectPtr>(candidate_effect.variants[variant])
                     : candidate_effect.make(&winner.where(), candidate_effect.values[variant]);
    if (!added) return tl::unexpected(added.error());
    out.added.push_back(*std::move(added));
  }
  for (const Pick& p : picked) {
    auto added =
        candidate_effect.make(&candidate_effect.hypotheses[p.hypothesis], candidate_effect.values[p.variant]);
    if (!added) return tl::unexpected(added.error());
    out.added.push_back(*std::move(added));
  }
  for (const effects::EffectPtr& effect : model) {
    if (std::none_of(out.added.begin(), out.added.end(),
                     [&](const effects::EffectPtr& added) { return holds(*added, *effect); }))
      out.model.push_back(effect);
  }
  out.model.insert(out.model.end(), out.added.begin(), out.added.end());
  return out;
}

}  // namespace mgtd::calib::criticism::search
