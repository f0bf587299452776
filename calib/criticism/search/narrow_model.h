// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "calib/fit/joint/joint_fit.h"
#include "calib/fit/joint/joint_setup.h"
#include "calib/poses/pose_table.h"

/// narrow_model() takes effects out of a model and leaves it where the fit with them ended: what tests about
/// that point see is what those effects account for, with the other parameters hardly bent by their absence.
namespace mgtd::calib::criticism::search {

struct NarrowModel {
  fit::joint::JointProblem problem;
  fit::joint::JointState state;  ///< parameters, nuisances and coefficients are those of the wider fit
};

/// The model that `options` ask for, with the state and the weights of `with`. Its effects are told by their
/// specs. Empty where the problem cannot be set up, or is one of other poses than `with`.
[[nodiscard]] std::optional<NarrowModel> narrow_model(const PoseTable& table,
                                                      const fit::joint::JointOptions& options,
                                                      const fit::joint::JointFit& with);

}  // namespace mgtd::calib::criticism::search
