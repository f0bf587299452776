// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "calib/criticism/tests/score.h"

/// find_dipole() and find_dipoles() search for the places of one or two dipoles at which chi-square falls
/// most, to first order in everything but the places.
///
/// With Z(p) the projected columns of the moments at places p, S(p) = |P_Z(p) r|^2. Each place is tried at a
/// grid of directions and distances, two dipoles at every pair of them, since several places make the same
/// gradient; from the best of them p is stepped by Gauss-Newton in moments and places together (variable
/// projection), damped, until S stands. Distances from 0.3 to 5 m: nearer a dipole would hit the array, and
/// what is further away is a gradient to these sensors.
namespace mgtd::calib::criticism::tests {

struct FoundDipole {
  effects::EffectPtr effect{};  ///< at that place, the shift zero
  Signature signature;          ///< of moment and shift, both, at that place and its moment
};

using DipoleAt = std::function<Result<effects::EffectPtr>(const Eigen::Vector3d& place_S_m)>;

/// Empty where no place has anything to tell.
[[nodiscard]] std::optional<FoundDipole> find_dipole(const fit::joint::JointProblem& problem,
                                                     const fit::joint::JointState& state,
                                                     const Residual& residual, const DipoleAt& dipole);

struct FoundDipoles {
  std::vector<effects::EffectPtr> effects{};  ///< each at its place, the shift zero
  Eigen::VectorXd moments_Am2{};              ///< three for each
  double S{0};                                ///< of the dipoles and what acts beside them, together
};

/// One or two (`count`) dipoles. `beside`: orthonormal columns of what acts beside them, in the space of
/// residual.value(); may have no column. Empty where no place has anything to tell.
[[nodiscard]] std::optional<FoundDipoles> find_dipoles(const fit::joint::JointProblem& problem,
                                                       const fit::joint::JointState& state,
                                                       const Residual& residual, const DipoleAt& dipole,
                                                       int count, const Eigen::MatrixXd& beside);

}  // namespace mgtd::calib::criticism::tests
