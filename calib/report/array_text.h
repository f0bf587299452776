// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/calibration/field_expansion.h"

namespace mgtd::calib::report {

/// what_it_tells() says, for a person, what an array can measure by the places of its sensors, in clauses
/// separated by "; ": where the field is meant, which components of the gradient are determined and why the
/// others are not, which of them are measured twice or follow from the vanishing divergence alone, and how
/// many closure numbers are left for what. Says nothing of how accurate it is.
///
///     field and all five independent components of the gradient; the sensors do not stand apart in z, so Gzz
///     is not measured and follows from the vanishing divergence; Gxy is measured twice and checks itself; 4
///     closure numbers check every sample (1 for a curl, 3 for a change that is not linear)
[[nodiscard]] std::string what_it_tells(const calibration::FieldExpansion& array);

/// "(0.2, 0, -0.2)": a place or a direction, rounded to multiples of `step`.
[[nodiscard]] std::string point_text(const Eigen::Vector3d& r, double step = 1e-4);

}  // namespace mgtd::calib::report
