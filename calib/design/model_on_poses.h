// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "calib/fit/joint/joint_fit.h"
#include "proto/error.h"

/// model_on_poses() applies the model of a fit to poses that it was not fitted to. What a further measurement
/// would tell is computed from it, without readings of that measurement.
namespace mgtd::calib::design {

struct ModelOnPoses {
  fit::joint::JointProblem problem;  ///< weights, gauge and table as those of the fit
  fit::joint::JointState state;      ///< parameters of the fit; attitudes and fields of these poses
};

/// Readings of further poses stand for their attitude and field only. Keeps pointers into `table`. Refuses
/// what the joint fit refuses.
[[nodiscard]] Result<ModelOnPoses> model_on_poses(const PoseTable& table, const fit::joint::JointFit& fit,
                                                  const fit::joint::JointOptions& options);

/// Rows by the coefficients of several effects, one after the other, as criticism::tests::effect_rows().
/// Refuses an effect that these poses cannot feed.
[[nodiscard]] Result<Eigen::MatrixXd> rows_of(const ModelOnPoses& model, const PoseTable& table,
                                              const std::vector<std::string>& specs);

}  // namespace mgtd::calib::design
