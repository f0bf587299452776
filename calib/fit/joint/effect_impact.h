// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/fit/joint/joint_fit.h"

namespace mgtd::calib::fit::joint {

/// effect_impact() says how wrong a calibration becomes when its model lacks an effect that acts with these
/// coefficients: the parameters take up what they can of it, dp = S_pp^-1 S_pe c, with S the information of
/// the fit with the effect (p: its fixed block without the effect, e: the effect), nuisances eliminated. The
/// shift is given as it shows in the tensor of a uniform field of the run's strength, root mean square over
/// all attitudes.
///
/// What the effect does to the readings of a survey itself is not in it.
struct EffectImpact {
  double nT_per_m{0};       ///< of the component that moves most; NaN where the array can tell none
  std::string component{};  ///< "xx", ...
};

/// `effect` is not in the model of `fit`. Refuses a fit that leaves something undetermined.
[[nodiscard]] Result<EffectImpact> effect_impact(const JointFit& fit, const effects::EffectPtr& effect,
                                                 const Eigen::VectorXd& coefficients);

}  // namespace mgtd::calib::fit::joint
