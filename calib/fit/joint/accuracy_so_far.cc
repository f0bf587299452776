// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/accuracy_so_far.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/fit/joint/joint_report.h"
#include "calib/fit/joint/pose_residuals.h"
#include "calib/fit/joint/tensor_uncertainty.h"

namespace mgtd::calib::fit::joint {

double AccuracySoFar::worst_nT_per_m() const {
  double worst = std::numeric_limits<double>::quiet_NaN();
  for (const double sd : components(tensor_sd_nT_per_m)) worst = std::fmax(worst, sd);  // passes over NaN
  return worst;
}

FitSoFar fit_so_far(const Eigen::MatrixXd& covariance, std::size_t sensors, double residual_nT) {
  FitSoFar out{.residual_nT = residual_nT, .offset_sd_nT = 0, .scale_sd = 0, .angle_sd_rad = 0};
  for (std::size_t at = 0; at < sensors * sensor::kSensorParameters; ++at) {
    const auto kind = static_cast<int>(at % sensor::kSensorParameters);
    const auto k = static_cast<Eigen::Index>(at);
    double& largest = kind >= sensor::ix && kind <= sensor::iz   ? out.offset_sd_nT
                      : kind >= sensor::cx && kind <= sensor::cz ? out.scale_sd
                                                                 : out.angle_sd_rad;
    out.parameter_sd.push_back(std::sqrt(std::max(0.0, covariance(k, k))));
    largest = std::max(largest, out.parameter_sd.back());
  }
  return out;
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
      fit_so_far(fit->covariance, fit->state.sensors.size(),
                 pose_residuals(fit->problem, fit->state).residual_nT()),
      std::move(fit->state)};
}

}  // namespace mgtd::calib::fit::joint
