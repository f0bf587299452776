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

/// `table`: the poses that were fitted, which keep the weights of the fit, then further ones, whose readings
/// stand for their attitude and field only. Keeps pointers into `table`. Refuses what the joint fit refuses.
[[nodiscard]] Result<ModelOnPoses> model_on_poses(const PoseTable& table, const fit::joint::JointFit& fit,
                                                  const fit::joint::JointOptions& options);

/// The run that was fitted, with the prediction of the model for every reading that the fit left out: poses
/// that further ones can be made from.
[[nodiscard]] PoseTable with_predictions(const PoseTable& run, const fit::joint::JointFit& fit);

/// Rows by the coefficients of several effects, one after the other, as criticism::tests::effect_rows().
/// Refuses an effect that these poses cannot feed.
[[nodiscard]] Result<Eigen::MatrixXd> rows_of(const ModelOnPoses& model, const PoseTable& table,
                                              const std::vector<std::string>& specs);

}  // namespace mgtd::calib::design
