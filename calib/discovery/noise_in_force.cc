// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/noise_in_force.h"

#include <cmath>

#include "calib/criticism/tests/judgement.h"

namespace mgtd::calib::discovery {
namespace {

namespace tests = criticism::tests;

/// Correlation from pose to pose that changes no finding: white noise shows as much.
constexpr double kUncorrelated = 0.1;

NoiseInForce measured(fit::joint::JointFit fit, double rho, tests::NoiseReference noise, bool wanders) {
  tests::Residual residual(fit.problem, fit.state, rho < kUncorrelated ? 0 : rho);
  residual.measure_by(noise.scale2);
  noise.chi2 = residual.chi2(), noise.dof = residual.dof();
  return {std::move(fit), std::move(residual), noise, wanders};
}

}  // namespace

NoiseInForce noise_in_force(const fit::joint::JointFit& fit, const tests::CandidateEffects& candidates,
                            std::uint64_t seed) {
  const tests::Judgement judged = tests::judge(fit, candidates, seed);
  const tests::Criticism& c = judged.criticism;
  const bool wanders = c.noise.wandering.any();
  tests::NoiseReference noise = c.noise.reference;
  // A model far off and offsets that wander leave no noise to measure by: what the readings say counts.
  const bool lasting = c.noise.correlated() || !c.noise.known;
  if (!lasting && std::isinf(noise.nu)) noise.scale2 = 1, noise.known = true;
  return measured(tests::at_stated_weights(wanders ? judged.fit : *c.tested), wanders ? 0 : c.noise.rho,
                  noise, wanders);
}

NoiseInForce noise_beside_law(const fit::joint::JointFit& fit, const NoiseInForce& with) {
  fit::joint::JointFit out = tests::at_stated_weights(fit);
  for (std::size_t k = 0; k < out.problem.poses.size(); ++k) {
    out.problem.poses[k].weight = with.fit.problem.poses[k].weight;
    out.problem.poses[k].f_weight = with.fit.problem.poses[k].f_weight;
    out.problem.poses[k].attitude_weight = with.fit.problem.poses[k].attitude_weight;
    out.problem.poses[k].reference_weight = with.fit.problem.poses[k].reference_weight;
  }
  fit::joint::refit_nuisances(out.problem, out.state);
  return measured(std::move(out), with.residual.whitener().rho(), with.noise, with.wanders);
}

}  // namespace mgtd::calib::discovery
