// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/fit/joint_fit.h"

/// The model that a search ended with, made tidy. A search adds effects one by one, with numbers from a
/// coarse grid and, while much else is still wrong, on more axes than need them.
namespace mgtd::calib {

/// Numbers that were tried on a grid (the width of a hysteresis, the threshold of a gain) are searched anew
/// with everything in the model; of an effect on each axis only those axes stay, if they are few, whose
/// coefficient is told from zero. The first `given` effects of the model are not touched. Refuses what a fit
/// refuses.
[[nodiscard]] Result<std::vector<EffectPtr>> polished(const PoseTable& table, const JointOptions& options,
                                                      std::size_t given);

}  // namespace mgtd::calib
