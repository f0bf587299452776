// SPDX-License-Identifier: Apache-2.0
#include "calib/validity/restricted_fit.h"

#include <optional>
#include <utility>

#include "calib/fit/joint/joint_cost.h"
#include "calib/validity/change.h"

namespace mgtd::calib::validity {
namespace {

struct Lower {
  fit::joint::JointState state;
  double cost;
};

/// A state along the step, of less cost; nothing when there is none.
std::optional<Lower> along(const fit::joint::JointProblem& problem, const fit::joint::JointState& from,
                           Eigen::VectorXd step, double cost) {
  constexpr int kHalvings = 12;
  for (int i = 0; i < kHalvings; ++i, step /= 2) {
    fit::joint::JointState there = from.moved(step);
    fit::joint::refit_nuisances(problem, there);
    const double lower = fit::joint::cost_of(problem, there).total();
    if (lower < cost) return Lower{std::move(there), lower};
  }
  return std::nullopt;
}

}  // namespace

fit::joint::JointState restricted_fit(const fit::joint::JointProblem& problem,
                                      const std::vector<Eigen::Index>& slots, fit::joint::JointState state) {
  constexpr int kSteps = 20;
  constexpr double kSettled = 1e-3;  // in chi-square
  fit::joint::refit_nuisances(problem, state);
  double cost = fit::joint::cost_of(problem, state).total();
  for (int i = 0; i < kSteps; ++i) {
    const fit::joint::Reduced reduced = fit::joint::reduce(problem, state, 0);
    Eigen::VectorXd step = Eigen::VectorXd::Zero(problem.fixed());
    step(slots) = inverse_of(reduced.S(slots, slots)).W * reduced.g(slots);
    auto lower = along(problem, state, std::move(step), cost);
    if (!lower) break;
    const double fall = cost - lower->cost;
    state = std::move(lower->state), cost = lower->cost;
    if (fall < kSettled) break;
  }
  return state;
}

}  // namespace mgtd::calib::validity
