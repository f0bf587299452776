// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/discovery/law_round.h"

/// library_beside() scores the library's effects in what some laws leave: the directions of these laws are
/// out of the columns and out of the residual, as they are for the formulas that the effects are ranked with.
namespace mgtd::calib::discovery {

/// Of bench.library, without its signatures.
[[nodiscard]] std::vector<criticism::tests::ScoredFamily> library_beside(
    const Workbench& bench, const std::vector<const FittedLaw*>& laws, const Eigen::MatrixXd& of_gradient);

}  // namespace mgtd::calib::discovery
