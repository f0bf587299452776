// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>

#include "calib/criticism/tests/score.h"

/// The place of a dipole in which chi-square falls most, to first order in everything but the place.
///
/// With Z(p) the projected columns of the moment at place p, S(p) = |P_Z(p) r|^2. It is tried at a grid of
/// directions and distances, since several places make the same gradient; from the best of them p is stepped
/// by Gauss-Newton in moment and place together (variable projection), damped, until S stands. Distances from
/// 0.3 to 3 m: nearer a dipole would hit the array, and what is further away is a gradient to these sensors.
namespace mgtd::calib::criticism::tests {

struct FoundDipole {
  effects::EffectPtr effect{};  ///< at that place, the shift zero
  Signature signature{};        ///< of moment and shift, both, at that place and its moment
};

using DipoleAt = std::function<Result<effects::EffectPtr>(const Eigen::Vector3d& place_S_m)>;

/// Empty where no place has anything to tell.
[[nodiscard]] std::optional<FoundDipole> find_dipole(const fit::joint::JointProblem& problem,
                                                     const fit::joint::JointState& state,
                                                     const Residual& residual, const DipoleAt& dipole);

}  // namespace mgtd::calib::criticism::tests
