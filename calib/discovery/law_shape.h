// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "calib/discovery/fitted_law.h"

/// A LawShape is the curve of a law over one covariate, with its band, found without a formula. It consists
/// of cubic B-splines on the octiles of the covariate, or of six harmonics of the azimuth, times the reading
/// for a gain, under a prior of curvature whose scale is that of the largest evidence,
///
///     beta = C Z'r,   C = (Z'Z + P)^-1,   P = tau_c D'D + tau_r 1,   D second differences.
///
/// Gauge: a constant is a parameter of the calibration (and so is a slope, of a curve over the reading
/// itself), so that curve, band and every formula drawn beside it have their projection on it taken out.
namespace mgtd::calib::discovery {

struct LawShape {
  std::string covariate{}, where{};
  bool of_gain{false};  ///< nT at a reading of 50 000 nT
  std::vector<double> x{}, y_nT{}, sd_nT{};
  double simultaneous{1.96};  ///< in sd: the whole curve is inside with 95 %
  struct Formula {
    std::string formula{};
    std::vector<double> y_nT{};  ///< at x, in the same gauge
  };
  std::vector<Formula> formulas{};
};

/// Over the covariate of the first formula, on the axis where it is largest, with the other formulas of the
/// same covariate. Empty where a formula depends on several quantities (but for a gain), or on what was
/// before.
[[nodiscard]] Result<std::optional<LawShape>> law_shape(const std::vector<FittedLaw>& formulas,
                                                        const std::vector<std::string>& covariates,
                                                        LawInputs& inputs, const ChannelSums& sums,
                                                        std::uint64_t seed);

}  // namespace mgtd::calib::discovery
