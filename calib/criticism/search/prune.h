// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>

#include "calib/fit/joint/joint_fit.h"

/// The model that a search ended with, made tidy. A search adds effects one by one, with numbers from a
/// coarse grid and, while much else is still wrong, on more axes than need them.
namespace mgtd::calib {

/// Of an effect on each axis only those axes stay, if they are few, whose coefficient is told from zero; then
/// the numbers that were tried on a grid are refined (nonlinear_parameters.h). The first `given` effects of
/// the model are not touched. `options` and `fit` go along; where a fit fails both stay as they were.
void prune(const PoseTable& table, std::size_t given, JointOptions& options, JointFit& fit);

}  // namespace mgtd::calib
