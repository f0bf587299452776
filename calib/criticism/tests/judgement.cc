// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/judgement.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "calib/criticism/tests/likeliest_rates.h"
#include "calib/criticism/tests/wandering_alternative.h"
#include "calib/fit/joint/wandering_covariance.h"
#include "calib/linear/parts.h"
#include "calib/stats/chi_square.h"

namespace mgtd::calib::criticism::tests {
namespace {

/// Families that are asked: those that stood out first.
constexpr std::size_t kQuestions = 8;
/// Of 2 ln of the odds. A single axis that wanders where eleven do not is a guess of its own: a law on that
/// axis need only be the better one.
constexpr double kClearlyBetter = 6;
/// Step of the walk from pose to pose over the noise, up to which a few slow terms describe it.
constexpr double kMild = 0.7;

Eigen::MatrixXd rows_of(const WanderingAlternative& alternative, const ScoredFamily& family,
                        const Score& score) {
  const effects::EffectPtr& effect = family.candidate_effect->variants[score.variant];
  return effect_rows(alternative.problem(), alternative.state(), effect) *
         family.candidate_effect->hypotheses[score.hypothesis].combine;
}

/// The winner, and the best on a single axis: where all axes wander the winner acts on all of them.
std::vector<const Score*> questions(const ScoredFamily& family) {
  std::vector<const Score*> out{&family.winner()};
  const Score* one = nullptr;
  for (const Score& score : family.scores)
    if (family.candidate_effect->hypotheses[score.hypothesis].axes == 1 &&
        (one == nullptr || score.S > one->S))
      one = &score;
  if (one != nullptr && one != out.front()) out.push_back(one);
  return out;
}

/// log10 p of families against the walk, by name, and what still wanders beside the best that passed.
struct AgainstWalk {
  std::map<std::string, double> log10_p{};
  double least{0};
  bool passed{false};
  fit::joint::WanderingEstimate beside{};
};

/// log10 p of one question against the walk.
double against(const WanderingAlternative& alternative, const ScoredFamily& family, const Score& score,
               const Eigen::MatrixXd& rows) {
  const auto [R, instead, rank] = alternative.ratio(rows);
  if (rank == 0) return 0;
  const Hypothesis& h = family.candidate_effect->hypotheses[score.hypothesis];
  const bool same_axis = h.axes == 1 && alternative.estimate().where == std::vector<std::string>{h.where};
  if (same_axis && instead > kClearlyBetter) return family.calibrated;
  return best_of(std::min(0.0, stats::chi_square_log10_p(std::max(R, 0.0), rank) + std::log10(h.alike)),
                 family.asked);
}

/// A family with one of its scores.
struct Question {
  const ScoredFamily& family;
  const Score& score;
  double log10_p{0};
};

void ask(const WanderingAlternative& alternative, const Criticism& c, AgainstWalk& out) {
  std::vector<Question> all;
  std::size_t asked = 0;
  for (std::size_t f = 0; f < c.families.size() && asked < kQuestions && c.rejects_named(f); ++f) {
    const ScoredFamily& family = c.families[f];
    if (out.log10_p.contains(family.candidate_effect->name)) continue;
    ++asked;
    for (const Score* score : questions(family)) all.push_back({family, *score});
  }
  linear::for_each_part(all.size(), [&](std::size_t i) {
    Question& q = all[i];
    q.log10_p = against(alternative, q.family, q.score, rows_of(alternative, q.family, q.score));
  });
  const Question* best = nullptr;
  for (const Question& q : all) {
    double& p = out.log10_p[q.family.candidate_effect->name];
    p = std::min(p, q.log10_p);
    if (best_of(p, c.rates.best) >= std::log10(kNamedAlarm) || p >= out.least) continue;
    out.least = p, out.passed = true;
    best = &q;
  }
  if (best != nullptr) out.beside = alternative.beside(rows_of(alternative, best->family, best->score));
}

/// The largest step from one pose to the next, in units of the noise of a pose mean.
double step_over_noise(const fit::joint::JointFit& fit, const fit::joint::WanderingRates& nT_per_sqrt_h) {
  const auto& poses = fit.problem.poses;
  fit::joint::Channels squares = fit::joint::Channels::Zero(poses.front().y_nT.size());
  double from_h = poses.front().t_h, to_h = from_h;
  for (const fit::joint::JointPose& pose : poses) {
    squares += pose.weight.cwiseAbs2();
    from_h = std::min(from_h, pose.t_h);
    to_h = std::max(to_h, pose.t_h);
  }
  const double n = static_cast<double>(poses.size());
  return (nT_per_sqrt_h.array() * (squares.array() / n).sqrt()).maxCoeff() * std::sqrt((to_h - from_h) / n);
}

/// A family is as probable as the walk lets it be.
void hold_against(const AgainstWalk& walk, Criticism& c) {
  for (ScoredFamily& family : c.families) {
    const auto found = walk.log10_p.find(family.candidate_effect->name);
    if (found != walk.log10_p.end()) family.calibrated = std::max(family.calibrated, found->second);
  }
  std::stable_sort(c.families.begin(), c.families.end(),
                   [](const ScoredFamily& a, const ScoredFamily& b) { return a.calibrated < b.calibrated; });
}

/// The walk that the tests stand against, with a margin for what its rates are known to: sixteen terms tell a
/// rate to a fifth, of twelve one is two such fifths too low, and a slow law is not to be named for that.
fit::joint::WanderingRates with_margin(const fit::joint::WanderingRates& rates,
                                       const fit::joint::WanderingEstimate& found) {
  constexpr double kMargin = 2;  // standard deviations
  const auto wanders = found.size.array() > 0;
  const Eigen::ArrayXd margin =
      wanders.select(1 + kMargin * found.sd.array() / found.size.array().max(1e-300), 1.0);
  return (rates.array() * margin).matrix();
}

/// The readings' noise times a factor; scalar reference and table stay as good as they are.
fit::joint::JointFit with_noise(const fit::joint::JointFit& stated, double factor) {
  fit::joint::JointFit out = stated;
  for (fit::joint::JointPose& pose : out.problem.poses) pose.weight /= factor;
  fit::joint::refit_nuisances(out.problem, out.state);
  return out;
}

/// What the tests stand against.
struct Against {
  fit::joint::JointFit fit;
  fit::joint::WanderingRates rates;
  double factor{1};  ///< of the readings' noise over that of the dwells
};

double largest_fall(const Criticism& c) {
  double out = 0;
  for (const ScoredFamily& family : c.families)
    out = std::max(out, family.winner().S * c.noise.reference.scale2);
  return out;
}

/// Beside the walk the white noise may be larger than the dwells say, as 1/f noise or correlated samples make
/// it. It is taken for that where this describes the readings better than any law does, by `fall` in
/// chi-square. Empty where the dwells stay what counts.
std::optional<Against> beside_larger_noise(const fit::joint::JointFit& stated, const Against& dwells,
                                           const fit::joint::WanderingEstimate& found, double fall) {
  constexpr double kStep = 1.25, kMost = 20;
  constexpr double kEnoughOdds = 20;  // of 2 ln of the odds
  double factor = 1, least = deviance_of(stated, dwells.rates) - std::max(fall, kEnoughOdds);
  fit::joint::WanderingRates rates;
  for (double at = kStep; at < kMost; at *= kStep) {
    const fit::joint::JointFit fit = with_noise(stated, at);
    const fit::joint::WanderingRates beside = likeliest_rates(fit, found.size, WhiteNoise::as_weighted);
    if (const double now = deviance_of(fit, beside); now < least) {
      least = now, factor = at, rates = beside;
    } else if (factor > 1) {
      break;
    }
  }
  if (!(factor > 1)) return std::nullopt;
  return Against{with_noise(stated, factor), rates, factor};
}

/// The tests against a walk, and where it needs to be beside larger noise.
Criticism judged_against_walk(const fit::joint::JointFit& stated, const fit::joint::WanderingEstimate& found,
                              const fit::joint::WanderingRates& at_white,
                              const CandidateEffects& candidate_effects, std::uint64_t seed,
                              const Rates& before) {
  Against against{stated, at_white};
  const auto tests = [&](const fit::joint::WanderingRates& rates) {
    Criticism out = criticise_against_walk(against.fit, rates, candidate_effects, seed, &before);
    if (!out.rejects_named()) look_at_maps(out);
    return out;
  };
  Criticism out = tests(against.rates);
  const double most = out.chi2 - out.dof - out.dof * std::log(std::max(1.0, out.chi2 / out.dof));
  if (out.rejects() && most > largest_fall(out)) {  // what a common factor of all noise could take away
    if (auto larger = beside_larger_noise(stated, against, found, largest_fall(out))) {
      against = *std::move(larger);
      out = tests(against.rates);
    }
  }
  // A law was asked with the rates free; what has no name was not.
  if (out.rejects() && !out.rejects_named()) out = tests(with_margin(against.rates, found));
  if (against.factor > 1) out.noise.beyond_dwells = against.factor;
  return out;
}

/// One axis follows time in a way that no walk does.
bool is_a_curve(const WanderingAlternative& alternative) {
  const std::vector<std::string>& all = alternative.estimate().where;
  if (all.size() != 1) return false;
  const auto where = effects::Where::parse(all.front());
  return where && where->scale == effects::Where::Scale::axis &&
         alternative.curve_instead(3 * where->sensor + where->axis) > 0;
}

}  // namespace

fit::joint::JointFit at_stated_weights(const fit::joint::JointFit& fit) {
  fit::joint::JointFit out = fit;
  if (!(fit.noise_inflation > 1)) return out;
  for (fit::joint::JointPose& pose : out.problem.poses) {
    pose.weight *= fit.noise_inflation;
    pose.f_weight *= fit.noise_inflation;
    pose.reference_weight *= fit.noise_inflation;
  }
  out.noise_inflation = 1;
  fit::joint::refit_nuisances(out.problem, out.state);
  return out;
}

Judgement judge(const fit::joint::JointFit& fit, const CandidateEffects& candidate_effects,
                std::uint64_t seed, const Rates* before) {
  Judgement out{.fit = fit, .criticism = criticise(fit, candidate_effects, seed, before)};
  if (!out.criticism.rejects_named()) look_at_maps(out.criticism);
  std::optional<WanderingAlternative> alternative;
  if (out.criticism.rejects_named() || out.criticism.rejects_map())
    alternative.emplace(*out.criticism.tested);
  fit::joint::WanderingEstimate found =
      alternative ? alternative->estimate() : fit::joint::WanderingEstimate{};
  const fit::joint::JointFit& judged = *out.criticism.tested;
  if (found.any() &&
      (found.evidence < fit::joint::kWanderingEvidence + fit::joint::unequal_noise_evidence(judged) ||
       is_a_curve(*alternative)))
    found = {};
  if (!found.any()) return out;
  AgainstWalk walk;
  const fit::joint::JointFit stated = at_stated_weights(judged);
  // A few slow terms do not tell a law from a walk that is far above the noise: a law then has to make it
  // vanish, or the tests stand against the walk as it was found without any law.
  const auto mild = [&](const fit::joint::WanderingRates& rates) {
    return step_over_noise(stated, rates) < kMild;
  };
  ask(*alternative, out.criticism, walk);
  fit::joint::WanderingRates rates;  // of `found`
  if (walk.passed && walk.beside.any())
    rates = likeliest_rates(stated, walk.beside.size, WhiteNoise::of_any_size);
  if (walk.passed && (!walk.beside.any() || mild(rates))) {
    found = std::move(walk.beside);
  } else {
    rates = likeliest_rates(stated, found.size, WhiteNoise::of_any_size);
    if (walk.passed || !mild(rates)) walk = {};
  }
  if (!found.any()) return out;
  const bool asked = !walk.log10_p.empty();
  if (auto covariance = fit::joint::covariance_with_wandering(
          out.fit, fit::joint::reduce(out.fit.problem, out.fit.state, 0),
          fit::joint::SlowCosines(out.fit.problem, out.fit.state), found))
    out.fit.covariance = *std::move(covariance);
  const Rates before_walk = std::move(out.criticism.rates);
  const double chi2 = out.criticism.chi2;
  out.criticism = judged_against_walk(stated, found, rates, candidate_effects, seed, before_walk);
  out.criticism.chi2 = chi2;
  if (asked) ask(*alternative, out.criticism, walk);
  hold_against(walk, out.criticism);
  out.criticism.noise.wandering = std::move(found);
  return out;
}

}  // namespace mgtd::calib::criticism::tests
