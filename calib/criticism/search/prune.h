// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>

#include "calib/fit/joint/joint_fit.h"

/// prune() simplifies the model that a search ended with. A search adds effects one by one, with numbers from
/// a coarse grid and, while much else is still wrong, on more axes than need them.
namespace mgtd::calib::criticism::search {

/// An effect on each axis keeps only those axes, if they are few, whose coefficient differs significantly
/// from zero; then the numbers that were tried on a grid are refined (nonlinear_parameters.h). The first
/// `given` effects of the model are not touched. Updates `options` and `fit`; where a fit fails both stay as
/// they were.
void prune(const PoseTable& table, std::size_t given, fit::joint::JointOptions& options,
           fit::joint::JointFit& fit);

}  // namespace mgtd::calib::criticism::search
