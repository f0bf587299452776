// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/likeliest_rates.h"

#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "calib/criticism/tests/residual.h"
#include "calib/linear/parts.h"

namespace mgtd::calib::criticism::tests {
namespace {

/// Of a long run, evenly chosen: a walk shows from one pose to the next.
constexpr std::size_t kStretches = 10, kStretch = 500;

/// Stretches of a fit's poses, in their order, as a problem of its own at the same state.
struct Part {
  fit::joint::JointProblem problem;
  fit::joint::JointState state;
};
Part part_of(const fit::joint::JointFit& fit) {
  const std::size_t all = fit.problem.poses.size();
  Part out{fit.problem, fit.state};
  out.problem.poses.clear();
  out.state.nuisances.clear();
  for (std::size_t s = 0; s < kStretches; ++s) {
    const std::size_t from = s * all / kStretches;
    for (std::size_t i = from; i < from + kStretch; ++i) {
      out.problem.poses.push_back(fit.problem.poses[i]);
      out.state.nuisances.push_back(fit.state.nuisances[i]);
    }
  }
  return out;
}

double deviance_of(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
                   const fit::joint::WanderingRates& rates, WhiteNoise white) {
  const Residual residual(problem, state, 0, rates);
  const double chi2 =
      white == WhiteNoise::as_weighted ? residual.chi2() : residual.dof() * std::log(residual.chi2());
  return chi2 + residual.whitener().log_det();
}

/// Rates times the factor at which a deviance is smallest.
fit::joint::WanderingRates at_least(fit::joint::WanderingRates rates, const auto& deviance) {
  constexpr double kFactor = 1.6;
  constexpr int kMost = 8;
  const std::array<double, 3> steps{1, kFactor, 1 / kFactor};
  std::array<double, 3> first{};
  linear::for_each_part(first.size(), [&](std::size_t i) { first[i] = deviance(rates * steps[i]); });
  const std::size_t towards = first[1] < first[0] ? 1 : 2;
  if (first[towards] >= first[0]) return rates;
  double least = first[towards];
  rates *= steps[towards];
  for (int i = 1; i < kMost;) {
    std::vector<fit::joint::WanderingRates> ahead;
    while (ahead.size() < linear::threads())
      ahead.push_back((ahead.empty() ? rates : ahead.back()) * steps[towards]);
    std::vector<double> next(ahead.size());
    linear::for_each_part(next.size(), [&](std::size_t k) { next[k] = deviance(ahead[k]); });
    for (std::size_t k = 0; k < next.size(); ++k) {
      if (next[k] >= least || i == kMost) return rates;
      least = next[k], rates = ahead[k];
      ++i;
    }
  }
  return rates;
}

}  // namespace

double deviance_of(const fit::joint::JointFit& fit, const fit::joint::WanderingRates& nT_per_sqrt_h) {
  double log_variances = 0;
  for (const fit::joint::JointPose& pose : fit.problem.poses)
    for (int c = 0; c < fit.problem.channels(); ++c)
      if (pose.weight[c] > 0) log_variances -= 2 * std::log(pose.weight[c]);
  return deviance_of(fit.problem, fit.state, nT_per_sqrt_h, WhiteNoise::as_weighted) + log_variances;
}

fit::joint::WanderingRates likeliest_rates(const fit::joint::JointFit& fit,
                                           fit::joint::WanderingRates nT_per_sqrt_h, WhiteNoise white) {
  std::optional<Part> part;
  if (fit.problem.poses.size() > kStretches * kStretch) part = part_of(fit);
  const fit::joint::JointProblem& problem = part ? part->problem : fit.problem;
  const fit::joint::JointState& state = part ? part->state : fit.state;
  return at_least(std::move(nT_per_sqrt_h), [&](const fit::joint::WanderingRates& at) {
    return deviance_of(problem, state, at, white);
  });
}

}  // namespace mgtd::calib::criticism::tests
