// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/discovery/channel_sums.h"
#include "calib/fit/joint/wandering.h"

/// A random offset is an alternative to every formula: the offset of a channel is f ~ N(0, a K), where it
/// walks (K from fit/joint/wandering.h) or jumps from pose to pose, unrelated to anything recorded (K = 1).
/// With K = A A', H = A' G A and z = A' s,
///
///     2 ln E = 2 ln of the mean over a of exp 1/2 [a z' (1 + a H)^-1 z - ln det(1 + a H)]
///
/// Over several channels one a holds for all.
namespace mgtd::calib::discovery {

enum class RandomOffset { walk, jumps };

/// 2 ln E. Empty channels, or a walk where the poses have no time: minus infinity.
[[nodiscard]] double evidence_of(RandomOffset kind, const std::vector<int>& channels, const ChannelSums& sums,
                                 const fit::joint::JointProblem& problem);

}  // namespace mgtd::calib::discovery
