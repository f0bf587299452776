// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <deque>

#include "calib/criticism/live/live_finding.h"
#include "calib/criticism/live/live_window.h"

/// criticise() tests whether the closure of a window follows a quantity of the instrument: temperature, time
/// or attitude.
///
/// Blocks are whitened by the noise of that many samples, times what correlation makes of it: the larger of
/// the median excess within blocks and the median scatter of the blocks about a regression on everything that
/// is tested (medians: what passes by is in few blocks). The variance of slopes is widened by the residual's
/// mean square and lag-one correlation r, (1+r)/(1-r).
///
///     temperature, time   slope beta of c on x, W free within its prior: beta' Cov^-1 beta, chi-square of d
///     attitude            slopes of c on the directions that the field took: against noise and prior,
///                         chi-square of d for each direction
namespace mgtd::calib::criticism::live {

struct WindowCriticism {
  std::array<Following, 3> follows;  ///< by Follows
  double noise_scale{1};             ///< variance of a block against white noise
};

[[nodiscard]] WindowCriticism criticise(const std::deque<ClosureBlock>& blocks, const ClosurePrior& prior);

/// Probability (decimal logarithm) that an intact calibration in a uniform gradient has the closure of one
/// block.
[[nodiscard]] double block_log10_p(const ClosureBlock& block, const ClosurePrior& prior, double noise_scale);

}  // namespace mgtd::calib::criticism::live
