// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/accuracy_so_far.h"

#include <cmath>
#include <limits>

#include "calib/fit/joint/joint_report.h"
#include "calib/fit/joint/tensor_uncertainty.h"

namespace mgtd::calib::fit::joint {

double AccuracySoFar::worst_nT_per_m() const {
  double worst = std::numeric_limits<double>::quiet_NaN();
  for (const double sd : components(tensor_sd_nT_per_m)) worst = std::fmax(worst, sd);  // passes over NaN
  return worst;
}

Result<AccuracySoFar> accuracy_so_far(const PoseTable& table, const FitOptions& options,
                                      const JointState* warm_start) {
  const JointOptions joint = joint_options(options);
  Result<JointFit> fit =
      warm_start != nullptr ? fit_joint(table, joint, *warm_start) : fit_joint(table, joint);
  // A start that lies in another gauge, or was spoilt by a bad pose, is no reason to know nothing.
  if (!fit && warm_start != nullptr) fit = fit_joint(table, joint);
  if (!fit) return tl::unexpected(fit.error());
  const double f_nT = fit->problem.common_field ? fit->state.f_nT : start_field_nT(fit->problem, joint);
  return AccuracySoFar{
      static_cast<int>(fit->problem.poses.size()),
      calibration_tensor_sd(fit->state.sensors, fit->problem.geometry, fit->covariance, f_nT),
      std::move(fit->state)};
}

}  // namespace mgtd::calib::fit::joint
