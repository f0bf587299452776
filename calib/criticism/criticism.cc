// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/criticism.h"

#include <algorithm>
#include <cmath>

#include "calib/chi_square.h"

namespace mgtd::calib {
namespace {

std::vector<double> evidence_by_pose(const ScoredFamily& family, const Residual& residual) {
  const Signature& s = family.signatures[family.winner().variant];
  const OneStep step = one_step(s, family.where());
  const Eigen::VectorXd fit = s.columns * (step.basis * (step.basis.transpose() * s.by_residual));
  const Eigen::VectorXd product = fit.cwiseProduct(residual.value());
  std::vector<double> out;
  for (Eigen::Index k = 0; k < residual.poses(); ++k)
    out.push_back(product.segment<kChannels>(k * kChannels).sum());
  return out;
}

/// Both tails of the residual's size, where its noise is known.
void judge_size(Criticism& out) {
  const NoiseReference& n = out.noise.reference;
  if (!n.known) return;
  const double x = out.chi2 / n.scale2;
  if (std::isinf(n.nu)) {
    out.omnibus_log10_p = chi_square_log10_p(x, out.dof);
    out.too_small_log10_p = std::log10(std::max(1 - chi_square_p(x, out.dof), 1e-300));
  } else if (out.noise.revisits) {
    out.omnibus_log10_p = out.noise.revisits->log10_p;
  }
}

bool below(double log10_p, double alarm) { return log10_p < std::log10(alarm); }

}  // namespace

bool Criticism::rejects_named() const {
  return !families.empty() && below(best_of(families.front().calibrated, independent), kNamedAlarm);
}
bool Criticism::rejects_map() const {
  return !maps.empty() && below(best_of(maps.front().log10_p, static_cast<double>(maps.size())), kMapAlarm);
}
bool Criticism::rejects_omnibus() const { return below(omnibus_log10_p, kOmnibusAlarm); }

Criticism criticise(const JointFit& fit, const Suspects& suspects, std::uint64_t seed) {
  const Residual residual(fit.problem, fit.state, pose_correlation(fit.problem, fit.state));
  Criticism out{.noise = noise_model(fit, residual), .chi2 = residual.chi2(), .dof = residual.dof()};
  for (const Suspect& suspect : suspects.testable) {
    ScoredFamily scored = score_family(fit.problem, fit.state, residual, out.noise.reference, suspect);
    if (scored.testable()) {
      out.families.push_back(std::move(scored));
    } else {
      out.untestable.push_back(
          {suspect.name, "calibration, attitude and field of these poses absorb it whole"});
    }
  }
  out.independent = calibrate(out.families, seed);
  std::stable_sort(out.families.begin(), out.families.end(),
                   [](const ScoredFamily& a, const ScoredFamily& b) { return a.calibrated < b.calibrated; });
  out.maps = score_maps(residual_maps(fit.problem, fit.state), residual, out.noise.reference);
  judge_size(out);
  if (!out.families.empty()) out.by_pose_winner = evidence_by_pose(out.families.front(), residual);
  return out;
}

}  // namespace mgtd::calib
