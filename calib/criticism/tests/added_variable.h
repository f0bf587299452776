// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/criticism/tests/residual.h"
#include "calib/criticism/tests/score.h"

/// added_variable() compares, pose by pose, what an effect that the model lacks would do with what the fit
/// leaves there. With r the residual, z what the effect in its fitted form makes of it (calibration,
/// attitudes and fields free in both) and r_k, z_k the part of pose k,
///     x_k = |z_k|,   y_k = z_k' r_k / |z_k|
/// lie about a line through the origin, in units of the noise: its slope is the size of the effect in units
/// of the size that was fitted, one, with standard deviation 1/sqrt(S). One pose with leverage shows as one
/// point far to the right.
namespace mgtd::calib::criticism::tests {

struct AddedVariable {
  std::vector<int> pose{};       ///< numbers
  std::vector<double> x{}, y{};  ///< in units of the noise
  std::vector<double> share{};   ///< of the evidence
  double slope{0}, slope_sd{0};
};

/// `fitted`: of the hypothesis asked about, from this signature. Empty where calibration takes all of it up.
[[nodiscard]] AddedVariable added_variable(const Signature& signature, const OneStep& fitted,
                                           const Residual& residual, const fit::joint::JointProblem& problem);

}  // namespace mgtd::calib::criticism::tests
