// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/criticism.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/criticism/tests/heavy_tails.h"
#include "calib/criticism/tests/scan_refinement.h"
#include "calib/fit/joint/pose_residuals.h"
#include "calib/linear/parts.h"
#include "calib/stats/chi_square.h"

namespace mgtd::calib::criticism::tests {
namespace {

/// A residual larger than its noise, where that is known.
void judge_size(Criticism& out) {
  const NoiseReference& n = out.noise.reference;
  if (!n.known) return;
  if (std::isinf(n.nu)) {
    out.omnibus_log10_p = stats::chi_square_log10_p(n.chi2, out.dof);
  } else if (out.noise.revisits) {
    out.omnibus_log10_p = out.noise.revisits->log10_p;
  }
}

/// A channel that scatters less than its noise. The scalar reference, whose uncertainty is often only a
/// bound, says nothing here.
void find_low_scatter(const fit::joint::JointFit& fit, Criticism& out) {
  if (!out.noise.reference.known) return;
  const calibration::AxisNoise ratio = fit::joint::pose_residuals(fit.problem, fit.state).noise_ratio;
  Eigen::Index sensor = 0, axis = 0;
  out.low_scatter_ratio = ratio.minCoeff(&sensor, &axis);
  out.low_scatter = fmt::format("s{}.{}", sensor + 1, "xyz"[axis]);
  const double nu = out.dof / static_cast<double>(ratio.size());
  const double more = stats::chi_square_p(std::pow(out.low_scatter_ratio, 2) * nu, nu);
  out.low_scatter_log10_p =
      std::min(0.0, std::log10(static_cast<double>(ratio.size()) * std::max(1 - more, 1e-300)));
}

/// The model holds this law: nothing of it is left to test.
bool in_model(const fit::joint::JointProblem& problem, const CandidateEffect& candidate_effect) {
  return std::any_of(problem.effects.begin(), problem.effects.end(), [&](const effects::EffectPtr& effect) {
    return effect->name() == candidate_effect.name;
  });
}

/// The model holds every coefficient of this law: what a test would see of it is what the gauge holds.
bool whole_in_model(const fit::joint::JointProblem& problem, const CandidateEffect& candidate_effect) {
  return candidate_effect.variants.size() == 1 &&
         std::any_of(problem.effects.begin(), problem.effects.end(), [&](const effects::EffectPtr& effect) {
           return effect->spec() == candidate_effect.variants.front()->spec();
         });
}

bool below(double log10_p, double alarm) { return log10_p < std::log10(alarm); }

/// Rates hardly move from one model to the next: those of the one before decide where the best p-value is a
/// factor of ten from its alarm.
void rate(const Rates* before, std::uint64_t seed, Criticism& out) {
  constexpr double kClear = 1;
  if (before != nullptr && calibrate(out.families, *before)) {
    double best = 0;
    for (const ScoredFamily& family : out.families) best = std::min(best, family.calibrated);
    out.rates = *before;
    if (std::abs(best_of(best, before->best) - std::log10(kNamedAlarm)) > kClear) return;
  }
  out.rates = draw_rates(out.families, seed);
  calibrate(out.families, out.rates);
}

double largest_S(const std::vector<ScoredFamily>& families) {
  double out = 0;
  for (const ScoredFamily& family : families) out = std::max(out, family.winner().S);
  return out;
}

/// Beside a memory of the noise, or offsets that wander, steps are asked about between every two poses.
void find_instants(Criticism& out) {
  constexpr double kRemembers = 0.3;
  const fit::joint::JointFit& fit = *out.tested;
  const Whitener& whitener = out.residual.whitener();
  if (whitener.rho() < kRemembers && !whitener.wanders()) return;
  std::vector<ScoredFamily*> of_instants;
  for (ScoredFamily& family : out.families)
    if (!family.candidate_effect->instants.empty()) of_instants.push_back(&family);
  linear::for_each_part(of_instants.size(), [&](std::size_t i) {
    try_every_instant(fit.problem, fit.state, out.residual, out.noise.reference, *of_instants[i]);
  });
}

/// Families that could still win with a better number. A dipole makes the gradient that is seen, once its
/// place is known: it comes as near as site.gradient does. A dipole that came during the run is looked for
/// where a step of the site is what stands out most.
void refine_alternatives(Criticism& out) {
  const fit::joint::JointFit& fit = *out.tested;
  constexpr double kInReach = 0.6;  // of the largest score
  const double largest = largest_S(out.families);
  double of_gradient = 0;
  std::vector<ScoredFamily*> in_reach;
  for (std::size_t f = 0; f < out.families.size(); ++f) {
    ScoredFamily& family = out.families[f];
    if (family.candidate_effect->name == "site.gradient") of_gradient = family.winner().S;
    if (family.winner().S >= kInReach * largest && out.rejects_named(f)) in_reach.push_back(&family);
  }
  linear::for_each_part(in_reach.size(), [&](std::size_t i) {
    refine(fit.problem, fit.state, out.residual, out.noise.reference, *in_reach[i]);
  });
  const double refined = largest_S(out.families);
  for (std::size_t f = 0; f < out.families.size(); ++f) {
    ScoredFamily& family = out.families[f];
    const bool came = family.candidate_effect->name == "site.step";
    const bool near =
        came ? family.winner().S == refined : std::max(family.winner().S, of_gradient) >= kInReach * refined;
    if (family.candidate_effect->dipole_at && near && out.rejects_named(f))
      refine_place(fit.problem, fit.state, out.residual, out.noise.reference, family);
  }
}

/// ScoredFamily::calibrated, if the score of its winning question were S.
double calibrated_at(double S, const ScoredFamily& family, const NoiseReference& noise) {
  const double priced =
      noise.log10_p(S, family.winner().k, family.where().axes) + std::log10(family.where().alike);
  return best_of(std::min(0.0, priced), family.asked);
}

/// A family that normal noise would make a name of is, where the tails are heavy, as probable as the scatter
/// of the poses lets it be.
void hold_against_tails(Criticism& c) {
  constexpr double kHeavy = 0.5;     // excess kurtosis; of normal noise in 157 poses 0.0 +- 0.1
  constexpr double kDecisive = -12;  // log10 p, that tails hardly make
  for (std::size_t f = 0; f < c.families.size(); ++f) {
    ScoredFamily& family = c.families[f];
    if (family.calibrated < kDecisive || !c.rejects_named(f)) continue;
    const TailsBeside tails = tails_beside(family, c.residual);
    if (tails.excess_kurtosis < kHeavy) continue;
    family.calibrated =
        std::max(family.calibrated, calibrated_at(tails.score_by_scatter, family, c.noise.reference));
  }
}

Criticism tested(const fit::joint::JointFit& of, Residual residual, const CandidateEffects& candidate_effects,
                 std::uint64_t seed, const Rates* before) {
  Criticism out{.residual = std::move(residual), .tested = std::make_shared<const fit::joint::JointFit>(of)};
  const fit::joint::JointFit& fit = *out.tested;  // the signatures refer to it
  out.noise = noise_model(fit, out.residual);
  out.chi2 = out.residual.chi2(), out.dof = out.residual.dof();
  out.residual.measure_by(out.noise.reference.scale2);
  std::vector<const CandidateEffect*> asked;
  for (const CandidateEffect& candidate_effect : candidate_effects.testable)
    if (!whole_in_model(fit.problem, candidate_effect)) asked.push_back(&candidate_effect);
  for (ScoredFamily& scored :
       score_families(fit.problem, fit.state, out.residual, out.noise.reference, asked)) {
    if (scored.testable()) {
      out.families.push_back(std::move(scored));
    } else if (!in_model(fit.problem, *scored.candidate_effect)) {
      out.untestable.push_back(
          {scored.candidate_effect->name, "calibration, attitude and field of these poses absorb it whole"});
    }
  }
  rate(before, seed, out);
  find_instants(out);
  refine_alternatives(out);
  hold_against_tails(out);
  std::stable_sort(out.families.begin(), out.families.end(),
                   [](const ScoredFamily& a, const ScoredFamily& b) { return a.calibrated < b.calibrated; });
  judge_size(out);
  find_low_scatter(fit, out);
  return out;
}

Residual among_poses(const fit::joint::JointFit& fit) {
  return {fit.problem, fit.state, pose_correlation(fit.problem, fit.state)};
}

/// Channels whose residual is beyond their noise by more than chance makes it.
int noisier_channels(const fit::joint::JointFit& fit) {
  constexpr double kSigmas = 3;
  const calibration::AxisNoise ratio = fit::joint::pose_residuals(fit.problem, fit.state).noise_ratio;
  const double chance = std::sqrt(2 * static_cast<double>(ratio.size()) / std::max(fit.dof, 1.0));
  return static_cast<int>((ratio.array().square() > 1 + kSigmas * chance).count());
}

/// The residual is larger than the dwells say, no revisit says that they are right, and no law accounts for
/// even half of it: then it may be the noise that is larger, and only what has a shape speaks of the model.
bool contradicts_dwells(const Criticism& c) {
  constexpr double kHalf = 0.5;
  constexpr double kUnequal = 40;  // chi-square with eleven degrees of freedom where all channels are alike
  const int kNoisier =
      c.tested->problem.channels() / 2;  // fewer: something is with these few, and no noise of the dwells
  const NoiseReference& n = c.noise.reference;
  if (!n.from_dwells() || !c.rejects_omnibus()) return false;
  if (c.noise.revisits && !c.noise.revisits->accounts_for_residual()) return false;
  if (noisier_channels(*c.tested) < kNoisier || fit::joint::unequal_noise_evidence(*c.tested) > kUnequal)
    return false;
  double largest = 0;
  for (const ScoredFamily& f : c.families) largest = std::max(largest, f.winner().S - f.winner().k);
  return largest < kHalf * (n.chi2 - n.dof);
}

/// The noise of each axis by what the fit left there, whatever the dwells say.
fit::joint::JointFit weighed_by_residual(const fit::joint::JointFit& fit) {
  constexpr int kRounds = 3;
  fit::joint::JointFit out = fit;
  out.sample_noise_nT.reset();
  for (int i = 0; i < kRounds; ++i) {
    const calibration::AxisNoise ratio = fit::joint::pose_residuals(out.problem, out.state).noise_ratio;
    for (fit::joint::JointPose& pose : out.problem.poses)
      for (int c = 0; c < out.problem.channels(); ++c) pose.weight[c] /= ratio(c / 3, c % 3);
    fit::joint::refit_nuisances(out.problem, out.state);
  }
  return out;
}

std::optional<fit::joint::ReferenceScatter> vector_scatter(const fit::joint::JointFit& fit) {
  PoseTable poses;
  for (const fit::joint::JointPose& pose : fit.problem.poses) poses.poses.push_back(*pose.pose);
  return fit::joint::reference_scatter(poses, fit);
}

}  // namespace

std::vector<double> Criticism::evidence_by_pose(std::size_t family) const {
  const ScoredFamily& f = families[family];
  const Signature& s = f.signatures[f.winner().variant];
  const Eigen::MatrixXd basis = orthonormal_combinations(s, f.where());
  const Eigen::VectorXd fit = s.times(basis * (basis.transpose() * s.by_residual()));
  const Eigen::VectorXd product = fit.cwiseProduct(residual.value());
  std::vector<double> out;
  for (Eigen::Index k = 0; k < residual.poses(); ++k)
    out.push_back(sensor::over_channels(residual.rows_per_pose(), [&](auto rows) {
      return product.segment(k * residual.rows_per_pose(), rows).sum();
    }));
  return out;
}

bool Criticism::rejects_named(std::size_t family) const {
  return family < families.size() && below(best_of(families[family].calibrated, rates.best), kNamedAlarm);
}
bool Criticism::would_name(std::size_t family, double S) const {
  const ScoredFamily& f = families[family];
  // What a walk or heavy tails made of the whole score they make of a part.
  const double raised = std::max(0.0, f.calibrated - calibrated_at(f.winner().S, f, noise.reference));
  const double part = std::min(0.0, calibrated_at(S, f, noise.reference) + raised);
  return below(best_of(part, rates.best), kNamedAlarm);
}
bool Criticism::rejects_map() const {
  return !maps.empty() && below(best_of(maps.front().log10_p, static_cast<double>(maps.size())), kMapAlarm);
}
bool Criticism::rejects_omnibus() const { return below(omnibus_log10_p, kOmnibusAlarm); }

Criticism criticise(const fit::joint::JointFit& fit, const CandidateEffects& candidate_effects,
                    std::uint64_t seed, const Rates* before) {
  Criticism out = tested(fit, among_poses(fit), candidate_effects, seed, before);
  if (!contradicts_dwells(out)) return out;
  const double chi2 = out.chi2;
  const Rates rates = std::move(out.rates);
  const std::optional<PureError> revisits = out.noise.revisits;
  const fit::joint::JointFit again = weighed_by_residual(fit);
  out = tested(again, among_poses(again), candidate_effects, seed, &rates);
  out.chi2 = chi2;
  out.noise.known = true;
  out.noise.revisits = revisits;
  out.noise.beyond_dwells =
      calibration::root_mean_square(fit::joint::pose_residuals(fit.problem, fit.state).noise_ratio);
  out.noise.vector = vector_scatter(fit);
  return out;
}

Criticism criticise_against_walk(const fit::joint::JointFit& fit,
                                 const fit::joint::WanderingRates& nT_per_sqrt_h,
                                 const CandidateEffects& candidate_effects, std::uint64_t seed,
                                 const Rates* before) {
  return tested(fit, Residual(fit.problem, fit.state, 0, nT_per_sqrt_h), candidate_effects, seed, before);
}

double chi2_at_stated_noise(const fit::joint::JointFit& fit, const Criticism& c, double table_sd_rad) {
  const double angles = table_sd_rad > 0 ? std::pow(fit.table_sd_rad / table_sd_rad, 2) : 1;
  double attitudes = 0;  // with those that are left out, which JointFit::chi2_table does not have
  for (std::size_t k = 0; k < fit.problem.poses.size(); ++k)
    if (const fit::joint::JointPose& pose = fit.problem.poses[k]; pose.has_angles)
      attitudes += (pose.attitude_weight * fit.state.nuisances[k].head<3>()).squaredNorm();
  return (c.chi2 - attitudes) * fit.noise_inflation * fit.noise_inflation + (attitudes - fit.chi2_table) +
         fit.chi2_table * angles;
}

void look_at_maps(Criticism& criticism) {
  const fit::joint::JointFit& fit = *criticism.tested;
  criticism.maps = score_maps(fit.problem, fit.state, criticism.residual, criticism.noise.reference);
}

}  // namespace mgtd::calib::criticism::tests
