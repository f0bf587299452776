// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/candidate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace mgtd::calib::criticism::tests {
namespace {

constexpr double kUnknownShare = std::numeric_limits<double>::quiet_NaN();

std::vector<calibration::EffectCoefficient> coefficients_of(const ScoredFamily& family) {
  const Signature& s = family.signatures[family.winner().variant];
  const OneStep step = one_step(s, family.where());
  const effects::EffectPtr& effect = family.candidate_effect->variants[family.winner().variant];
  std::vector<calibration::EffectCoefficient> out;
  for (Eigen::Index j = 0; j < step.value.size(); ++j) {
    Eigen::Index of = 0;
    family.where().combine.col(j).maxCoeff(&of);
    out.push_back({.name = family.where().names[static_cast<std::size_t>(j)],
                   .value = step.value[j],
                   .sd = std::sqrt(step.covariance(j, j)),
                   .unit = effect->coefficients()[static_cast<std::size_t>(of)].unit});
  }
  return out;
}

}  // namespace

Candidate candidate_of(const ScoredFamily& family, const Criticism& c, double noise_inflation) {
  const Score& score = family.winner();
  Candidate out{.effect = family.candidate_effect->name,
                .where = family.where().where,
                .spec = spec_of(*family.candidate_effect, family.where(), score.variant),
                .k = score.k,
                .log10_p = family.calibrated,
                .d = score.d(),
                .fall = score.S * c.noise.reference.scale2 * noise_inflation * noise_inflation,
                .coefficients = coefficients_of(family)};
  const double excess = c.noise.reference.chi2 - c.dof;
  out.share = !c.noise.reference.from_dwells() ? kUnknownShare
              : excess > 0                     ? std::clamp((score.S - score.k) / excess, 0.0, 1.0)
                                               : 0;
  if (family.candidate_effect->bound > 0) {
    out.plausible = std::all_of(out.coefficients.begin(), out.coefficients.end(), [&](const auto& x) {
      return std::abs(x.value) < family.candidate_effect->bound + 3 * x.sd;
    });
  }
  return out;
}

void weigh_poses(const fit::joint::JointFit& fit, const std::vector<double>& by_pose, Candidate& out) {
  std::vector<std::size_t> order(by_pose.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return by_pose[a] > by_pose[b]; });
  const double total = std::accumulate(by_pose.begin(), by_pose.end(), 0.0);
  out.largest_pose = by_pose.empty() ? 0 : by_pose[order.front()] / total;
  double sum = 0;
  for (const std::size_t k : order) {
    if (sum >= 0.5 * total) break;
    sum += by_pose[k];
    out.poses.push_back(fit.problem.poses[k].pose->number);
  }
}

std::optional<fit::joint::EffectImpact> impact_of(const fit::joint::JointFit& fit,
                                                  const ScoredFamily& family) {
  const std::size_t variant = family.winner().variant;
  const OneStep step = one_step(family.signatures[variant], family.where());
  auto impact = fit::joint::effect_impact(fit, family.candidate_effect->variants[variant],
                                          family.where().combine * step.value);
  return impact ? std::optional(*std::move(impact)) : std::nullopt;
}

const calibration::EffectCoefficient* seen_most(const Candidate& candidate) {
  const auto sigmas = [](const calibration::EffectCoefficient& c) {
    return std::abs(c.value) / std::max(c.sd, 1e-300);
  };
  const auto found = std::max_element(candidate.coefficients.begin(), candidate.coefficients.end(),
                                      [&](const auto& a, const auto& b) { return sigmas(a) < sigmas(b); });
  return found == candidate.coefficients.end() ? nullptr : &*found;
}

std::string place_of(const calibration::EffectCoefficient& coefficient) {
  const std::string& name = coefficient.name;
  const std::size_t sensor_end = name.find('.');
  return name.substr(0, sensor_end == std::string::npos ? sensor_end : name.find('.', sensor_end + 1));
}

}  // namespace mgtd::calib::criticism::tests
