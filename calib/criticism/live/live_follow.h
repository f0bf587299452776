// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <deque>
#include <string_view>

#include "calib/criticism/live/live_window.h"

/// Whether the closure of a window follows something of the instrument's.
///
/// Blocks are whitened by the noise of that many samples, times what correlation makes of it: the larger of
/// the median excess within blocks and the median scatter of the blocks about a regression on everything that
/// is tested (medians: what passes by is in few blocks). The variance of slopes is widened by the residual's
/// mean square and lag-one correlation r, (1+r)/(1-r).
///
///     temperature, time   slope beta of c on x, W free within its prior: beta' Cov^-1 beta, chi-square of 4
///     attitude            slopes of c on the directions that the field took: against noise and prior,
///                         chi-square of 4 for each direction
namespace mgtd::calib {

enum class Follows { temperature, time, attitude };
inline constexpr std::array<std::string_view, 3> kFollowsNames{"temperature", "time", "attitude"};

struct Following {
  bool tested{false};  ///< the window has enough blocks and x moves enough in it
  double log10_p{0};   ///< of so much by chance
  double share{0};     ///< of what the closure does beyond its noise
  /// The same of the best single interval of time: something that came and stayed or went, and follows
  /// nothing.
  double event_share{0};
  /// The quantity of the closure (0 curl, 1..3 centre x, y, z) in which it is largest for the standard
  /// deviation that the calibration states there: slope per unit of x, the swing over the window, that
  /// standard deviation.
  int component{0};
  double slope{0}, slope_sd{0}, swing{0}, stated_sd{0}, range{0};
};

struct WindowCriticism {
  std::array<Following, 3> follows;  ///< by Follows
  double noise_scale{1};             ///< variance of a block against white noise
};

[[nodiscard]] WindowCriticism criticise(const std::deque<ClosureBlock>& blocks, const ClosurePrior& prior);

/// Probability (decimal logarithm) that an intact calibration in a uniform gradient has the closure of one
/// block.
[[nodiscard]] double block_log10_p(const ClosureBlock& block, const ClosurePrior& prior, double noise_scale);

}  // namespace mgtd::calib
