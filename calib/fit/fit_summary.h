// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A FitSummary says how a fit ended: by which criterion its iterations stopped, how many there were, and how
/// far chi-square fell.
namespace mgtd::calib::fit {

enum class Termination {
  /// Linear equations, solved in one pass: nothing iterates (the two-step and the simplified method).
  closed_form,
  /// The next step would lower chi-square by less than kConverged (joint_limits.h), and neither the
  /// noise estimates nor the readings that are left out change any more.
  converged,
  /// The step limit was reached while chi-square only crept along a direction that is weakly known
  /// (kSlowFall): the solution is used.
  slow_progress,
  /// Noise estimates or left-out readings still changed after kMaxWeighingRounds rounds: the weights of the
  /// last round are used.
  round_limit,
};

/// Chi-squares are those of all observations under the final weights, readings that are left out excluded.
struct FitSummary {
  Termination termination{Termination::closed_form};
  int rounds{0};      ///< of solving, estimating the noise and leaving readings out; a closed form has none
  int iterations{0};  ///< steps of the solver, all rounds together
  double initial_cost{
      0};  ///< chi-square at the values that the solver began with; a closed form: of the raw readings
  double final_cost{0};

  /// Whether the fit may be called a minimum of chi-square for the noise that it states.
  [[nodiscard]] bool converged() const {
    return termination == Termination::closed_form || termination == Termination::converged;
  }
};

}  // namespace mgtd::calib::fit
