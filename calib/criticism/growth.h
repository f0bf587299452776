// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/criticism/score.h"

/// A model with the winner of a round in it.
namespace mgtd::calib {

/// What the winner holds already takes its place: the same law with the same fixed number on a part of the
/// winner's axes, "s3.z" in "each-axis". Everything else stays beside it. Refuses what the library refuses.
[[nodiscard]] Result<std::vector<EffectPtr>> grown(const std::vector<EffectPtr>& model,
                                                   const ScoredFamily& winner);

}  // namespace mgtd::calib
