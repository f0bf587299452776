// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/criticism/tests/criticism.h"

/// judge() tests a fit under the noise that its residual calls for.
///
/// Where nothing stands out against the assumed noise, nothing more is tested. Where something does, the
/// offsets may wander (wandering_estimate.h). Each law that stood out is then tested against the walk
/// (wandering_alternative.h), and only one that beats it can be named. The noise in force is what still
/// wanders beside the best such law, or everything that wanders where there is none.
namespace mgtd::calib::criticism::tests {

struct Judgement {
  fit::joint::JointFit fit;  ///< with the covariance of that noise
  Criticism criticism;
};

/// `before` as in criticise().
[[nodiscard]] Judgement judge(const fit::joint::JointFit& fit, const CandidateEffects& candidate_effects,
                              std::uint64_t seed, const Rates* before = nullptr);

/// The same fit with the weights that the readings are said to have, whatever JointFit::noise_inflation was
/// needed to settle it.
[[nodiscard]] fit::joint::JointFit at_stated_weights(const fit::joint::JointFit& fit);

}  // namespace mgtd::calib::criticism::tests
