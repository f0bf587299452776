// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/criticism.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/chi_square.h"
#include "calib/criticism/refinement.h"
#include "calib/fit/pose_residuals.h"

namespace mgtd::calib {
namespace {

/// A residual larger than its noise, where that is known.
void judge_size(Criticism& out) {
  const NoiseReference& n = out.noise.reference;
  if (!n.known) return;
  if (std::isinf(n.nu)) {
    out.omnibus_log10_p = chi_square_log10_p(n.chi2, out.dof);
  } else if (out.noise.revisits) {
    out.omnibus_log10_p = out.noise.revisits->log10_p;
  }
}

/// A channel that scatters less than its noise. The scalar reference, whose uncertainty is often only a
/// bound, says nothing here.
void judge_quiet(const JointFit& fit, Criticism& out) {
  if (!out.noise.reference.known) return;
  const AxisNoise ratio = pose_residuals(fit.problem, fit.state).noise_ratio;
  Eigen::Index sensor = 0, axis = 0;
  out.quiet_ratio = ratio.minCoeff(&sensor, &axis);
  out.quiet = fmt::format("s{}.{}", sensor + 1, "xyz"[axis]);
  const double nu = out.dof / kChannels;
  const double more = chi_square_p(std::pow(out.quiet_ratio, 2) * nu, nu);
  out.quiet_log10_p = std::min(0.0, std::log10(kChannels * std::max(1 - more, 1e-300)));
}

/// The model holds this law: nothing of it is left to test.
bool in_model(const JointProblem& problem, const Suspect& suspect) {
  return std::any_of(problem.effects.begin(), problem.effects.end(),
                     [&](const EffectPtr& effect) { return effect->name() == suspect.name; });
}

bool below(double log10_p, double alarm) { return log10_p < std::log10(alarm); }

/// Rates hardly move from one model to the next: those of the one before decide where the best p-value is a
/// factor of a hundred from its alarm.
void rate(const Rates* before, std::uint64_t seed, Criticism& out) {
  constexpr double kClear = 2;
  if (before != nullptr && calibrate(out.families, *before)) {
    double best = 0;
    for (const ScoredFamily& family : out.families) best = std::min(best, family.calibrated);
    out.rates = *before;
    if (std::abs(best_of(best, before->best) - std::log10(kNamedAlarm)) > kClear) return;
  }
  out.rates = draw_rates(out.families, seed);
  calibrate(out.families, out.rates);
}

/// Families that could still win with a better number.
void refine_contenders(const JointFit& fit, Criticism& out) {
  constexpr double kInReach = 0.6;  // of the largest score
  double largest = 0;
  for (const ScoredFamily& family : out.families) largest = std::max(largest, family.winner().S);
  for (std::size_t f = 0; f < out.families.size(); ++f) {
    if (out.families[f].winner().S < kInReach * largest || !out.rejects_named(f)) continue;
    refine(fit.problem, fit.state, out.residual, out.noise.reference, out.families[f]);
  }
}

}  // namespace

std::vector<double> Criticism::evidence_by_pose(std::size_t family) const {
  const ScoredFamily& f = families[family];
  const Signature& s = f.signatures[f.winner().variant];
  const OneStep step = one_step(s, f.where());
  const Eigen::VectorXd fit = s.columns * (step.basis * (step.basis.transpose() * s.by_residual));
  const Eigen::VectorXd product = fit.cwiseProduct(residual.value());
  std::vector<double> out;
  for (Eigen::Index k = 0; k < residual.poses(); ++k)
    out.push_back(product.segment<kChannels>(k * kChannels).sum());
  return out;
}

bool Criticism::rejects_named(std::size_t family) const {
  return family < families.size() && below(best_of(families[family].calibrated, rates.best), kNamedAlarm);
}
bool Criticism::rejects_map() const {
  return !maps.empty() && below(best_of(maps.front().log10_p, static_cast<double>(maps.size())), kMapAlarm);
}
bool Criticism::rejects_omnibus() const { return below(omnibus_log10_p, kOmnibusAlarm); }

Criticism criticise(const JointFit& fit, const Suspects& suspects, std::uint64_t seed, const Rates* before) {
  Criticism out{.residual = Residual(fit.problem, fit.state, pose_correlation(fit.problem, fit.state))};
  out.noise = noise_model(fit, out.residual);
  out.chi2 = out.residual.chi2(), out.dof = out.residual.dof();
  out.residual.measure_by(out.noise.reference.scale2);
  for (const Suspect& suspect : suspects.testable) {
    ScoredFamily scored = score_family(fit.problem, fit.state, out.residual, out.noise.reference, suspect);
    if (scored.testable()) {
      out.families.push_back(std::move(scored));
    } else if (!in_model(fit.problem, suspect)) {
      out.untestable.push_back(
          {suspect.name, "calibration, attitude and field of these poses absorb it whole"});
    }
  }
  rate(before, seed, out);
  refine_contenders(fit, out);
  std::stable_sort(out.families.begin(), out.families.end(),
                   [](const ScoredFamily& a, const ScoredFamily& b) { return a.calibrated < b.calibrated; });
  judge_size(out);
  judge_quiet(fit, out);
  return out;
}

double chi2_told(const JointFit& fit, const Criticism& c, double table_sd_rad) {
  const double angles = table_sd_rad > 0 ? std::pow(fit.table_sd_rad / table_sd_rad, 2) : 1;
  return (c.chi2 - fit.chi2_table) * fit.worse * fit.worse + fit.chi2_table * angles;
}

void look_at_maps(const JointFit& fit, Criticism& criticism) {
  criticism.maps =
      score_maps(residual_maps(fit.problem, fit.state), criticism.residual, criticism.noise.reference);
}

}  // namespace mgtd::calib
