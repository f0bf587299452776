// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/joint/joint_fit.h"
#include "calib/fit/joint/wandering.h"

/// likeliest_rates() says how fast offsets wander, from all poses and their correlation: the few slow terms
/// of wandering.h, which find where an offset wanders, do not see how a walk far above the noise goes on from
/// one pose to the next.
namespace mgtd::calib::criticism::tests {

/// -2 ln L of readings whose white noise is what the weights say, beside offsets that wander at these rates.
[[nodiscard]] double deviance_of(const fit::joint::JointFit& fit,
                                 const fit::joint::WanderingRates& nT_per_sqrt_h);

/// The white noise of the readings: as the weights say, or that times a factor that nobody knows. The rates
/// are then those beside white noise of the weights' size: both times the factor are the real ones.
enum class WhiteNoise { as_weighted, of_any_size };

/// Given rates times the power of 1.6 that the readings are most likely with, at most eight of them up or
/// down. Of a run of more than 5000 poses that many are asked, in ten stretches.
[[nodiscard]] fit::joint::WanderingRates likeliest_rates(const fit::joint::JointFit& fit,
                                                         fit::joint::WanderingRates nT_per_sqrt_h,
                                                         WhiteNoise white);

}  // namespace mgtd::calib::criticism::tests
