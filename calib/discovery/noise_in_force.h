// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "calib/criticism/tests/criticism.h"

/// NoiseInForce holds the residual in which laws are looked for, in units of the noise that the tests of the
/// library found (criticism/tests/judgement.h). Offsets that wander are not taken out: a walk is an
/// alternative to every formula.
namespace mgtd::calib::discovery {

struct NoiseInForce {
  fit::joint::JointFit fit;  ///< with the weights of that noise
  criticism::tests::Residual residual;
  criticism::tests::NoiseReference noise;
  bool wanders{false};
};

[[nodiscard]] NoiseInForce noise_in_force(const fit::joint::JointFit& fit,
                                          const criticism::tests::CandidateEffects& candidates,
                                          std::uint64_t seed);

/// The residual of `fit` in units of the noise that is left beside a law: what a law leaves in a residual
/// looks like larger or correlated noise until the law is in the model. `with` is of the same poses.
[[nodiscard]] NoiseInForce noise_beside_law(const fit::joint::JointFit& fit, const NoiseInForce& with);

}  // namespace mgtd::calib::discovery
