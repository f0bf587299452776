// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "calib/discovery/law_round.h"

/// These functions check a law in ways that had no part in choosing it. A half or a fold has its own
/// parameters of the calibration, projected out of it alone.
namespace mgtd::calib::discovery {

/// Size of the law in every second block of eight poses over that in the others; near one for a law. Empty
/// where a half is too short.
[[nodiscard]] std::optional<double> halves_ratio(const fit::joint::JointFit& fit, double scale2,
                                                 const FittedLaw& law);

/// Fall of chi-square on poses that took no part: in each of eight interleaved folds the search is repeated
/// without the fold, and the formula that leads there is held against it. What is named by chance does not
/// fall, or rises. Empty where noise is correlated from pose to pose, or a fold too short.
[[nodiscard]] Result<std::optional<double>> held_out_fall(const fit::joint::JointFit& fit,
                                                          const criticism::tests::Residual& residual,
                                                          const Workbench& bench);

/// How much formulas at one place, fitted alike, differ where every number lies half as far again from its
/// mean as it did in the run: the largest rms difference from the first over its rms. Empty for a formula
/// alone.
[[nodiscard]] Result<std::optional<double>> extrapolation_spread(const std::vector<FittedLaw>& formulas,
                                                                 const PoseTable& run,
                                                                 const fit::joint::JointFit& fit);

/// The axis on which most more is left than noise makes, in standard deviations of chi-square of its scores.
struct LeftOn {
  int channel{0};
  double sigmas{0};
};
[[nodiscard]] LeftOn left_on(const ChannelSums& sums);

}  // namespace mgtd::calib::discovery
