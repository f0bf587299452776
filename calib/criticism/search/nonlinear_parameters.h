// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/joint/joint_fit.h"

/// refine_nonlinear_parameters() fits the fixed numbers of the effects in a model (the width of a hysteresis,
/// the time constant of a settling) as parameters of their own.
///
/// With z(w) the columns of an effect and c its coefficients, dz/dw c is one more column. Its coefficient,
/// fitted to the residual beside everything else, is the step of w (Gauss-Newton); all numbers step together,
/// then the model is fitted again from where it was. A search over a grid, with a fit for each value, gets no
/// further.
namespace mgtd::calib::criticism::search {

/// Steps until the numbers settle, and updates `options` and `fit`. The first `given` effects keep theirs,
/// and so do numbers in which the model is not smooth (a threshold, an instant). Stops where a fit fails or
/// does not improve.
void refine_nonlinear_parameters(const PoseTable& table, std::size_t given, fit::joint::JointOptions& options,
                                 fit::joint::JointFit& fit);

}  // namespace mgtd::calib::criticism::search
