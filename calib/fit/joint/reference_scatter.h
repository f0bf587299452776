// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "proto/pose.h"

/// reference_scatter() measures how well a vector reference agrees with what else measures the field, and
/// compares that with what `ref_sd_nT` says.
///
/// Against f_nT, where at least 20 poses on a table have both: s^2 = var(|r| - f) - sd(f)^2. No model is in
/// that; how differently the field moves at the two places is.
/// Against the sensors, where the dwells tell their noise: s^2 = mean of (r - b)^2 less the variance of b, b
/// the field by the readings of the pose alone, corrected; on a table of the sizes |r| and F. What the fit
/// took of the residuals is accounted for. A law that the model lacks is in it.
namespace mgtd::calib::fit::joint {

struct JointFit;

struct ReferenceScatter {
  double measured_nT{0};  ///< standard deviation of a component, or of the size
  double stated_nT{0};    ///< root mean square of ref_sd_nT
  bool stated{true};      ///< the table has ref_sd_nT; else stated_nT is the default
  bool by_scalar{false};  ///< against f_nT, not the sensors
  /// The two differ by a factor of two or more, and by five standard deviations of the measured variance.
  bool differs{false};

  [[nodiscard]] bool less() const { return differs && measured_nT < stated_nT; }
  [[nodiscard]] bool more() const { return differs && measured_nT > stated_nT; }
};

/// Empty without a vector reference, and where nothing measures its scatter.
[[nodiscard]] std::optional<ReferenceScatter> reference_scatter(const PoseTable& table, const JointFit& fit);

}  // namespace mgtd::calib::fit::joint
