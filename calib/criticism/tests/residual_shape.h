// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/fit/joint/joint_fit.h"

/// These functions say whether the residuals of a fit are normally distributed, and whether those of one pose
/// depend on those of the poses before it.
///
/// A residual is taken in units of its own standard deviation: what the pose's own attitude and field took of
/// its freedom is allowed for (PoseResiduals). Readings that the fit left out are not among them.
namespace mgtd::calib::criticism::tests {

/// The i-th of n residuals in ascending order against the normal quantile of (i - 1/2)/n. `low` and `high`:
/// in 95 of 100 samples of independent normal numbers all n lie between. Of uniform order statistics U_i ~
/// Beta(i, n + 1 - i) each has the same chance
///     eta = -ln(0.95) / (2 ln ln n ln n) (1 - 1.591 lnlnln n / lnln n)      [Gontscharuk, Finner 2017]
/// to fall below `low`, and the same to lie above `high`. Above kMostQuantiles only some of the middle are
/// given.
struct ResidualQuantiles {
  std::size_t n{0};
  std::vector<double> quantile{}, residual{}, low{}, high{};
  std::vector<int> pose{};  ///< number of the pose that the residual is of
};
inline constexpr std::size_t kMostQuantiles = 600;
[[nodiscard]] ResidualQuantiles residual_quantiles(const fit::joint::JointFit& fit);

/// By sensor, lags 1, 2, ... in the order of time; the three axes together.
struct ResidualAutocorrelation {
  std::vector<std::vector<double>> by_sensor{};
  double bound{0};  ///< 95 of 100 of independent residuals lie within it
};
[[nodiscard]] ResidualAutocorrelation residual_autocorrelation(const fit::joint::JointFit& fit,
                                                               int lags = 20);

/// z with a share p of the normal distribution below it.
[[nodiscard]] double normal_quantile(double p);

}  // namespace mgtd::calib::criticism::tests
