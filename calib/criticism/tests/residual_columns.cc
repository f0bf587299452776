// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/residual_columns.h"

#include <cmath>
#include <limits>

#include "calib/calibration/tensor.h"
#include "calib/criticism/tests/measured_columns.h"
#include "calib/criticism/tests/residual_fields.h"
#include "calib/linear/cholesky.h"
#include "calib/linear/propagation.h"

namespace mgtd::calib::criticism::tests {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// What was left out has no residual in units of noise, and what is made of it has none either.
void hide_left_out(const fit::joint::JointFit& fit, ResidualColumns& out) {
  for (std::size_t k = 0; k < fit.problem.poses.size(); ++k) {
    const fit::joint::JointPose& pose = fit.problem.poses[k];
    const auto at = static_cast<Eigen::Index>(k);
    for (int c = 0; c < fit.problem.channels(); ++c) {
      if (pose.weight[c] > 0) continue;
      out.whitened(c, at) = kNotKnown;
      out.scalar_nT(c / 3, at) = kNotKnown;
      out.closure_nT.col(at).setConstant(kNotKnown);
    }
    if (!(pose.f_weight > 0)) out.scalar_nT.col(at).setConstant(kNotKnown);
    if (!pose.has_angles) out.attitude_deg.col(at).setConstant(kNotKnown);
  }
}

/// Empty where the array has no closure.
Eigen::VectorXd closure_chi2(const fit::joint::JointFit& fit, const Eigen::MatrixXd& closure_nT) {
  if (closure_nT.rows() == 0) return {};
  Eigen::MatrixXd rows = calibration::closure_rows(fit.problem.geometry);
  if (const auto baseline_m = fit.problem.geometry.cross_baseline_m()) rows.row(0) *= *baseline_m;
  Eigen::VectorXd variance(rows.cols());
  for (Eigen::Index c = 0; c < rows.cols(); ++c) variance[c] = std::pow(fit.pose_noise_nT(c / 3, c % 3), 2);
  const auto covariance = linear::Cholesky::of_unscaled(
      linear::propagated_covariance(rows, Eigen::MatrixXd(variance.asDiagonal())));
  if (!covariance) return {};
  Eigen::VectorXd out(closure_nT.cols());
  for (Eigen::Index k = 0; k < out.size(); ++k) out[k] = covariance->squared_length(closure_nT.col(k));
  return out;
}

}  // namespace

Eigen::MatrixXd residuals_nT(const fit::joint::JointFit& fit) {
  const fit::joint::PoseModel model(fit.problem, fit.state);
  fit::joint::PoseLinear linear;
  Eigen::MatrixXd out(fit.problem.channels(), static_cast<Eigen::Index>(fit.problem.poses.size()));
  for (Eigen::Index k = 0; k < out.cols(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    model.linearise(fit.problem.poses[at], fit.state.nuisances[at], linear);
    out.col(k) = fit.problem.poses[at].y_nT - linear.y_nT;
  }
  return out;
}

Result<ResidualColumns> residual_columns(const fit::joint::JointFit& fit) {
  auto influence = fit::joint::pose_influences(fit);
  if (!influence) return tl::unexpected(influence.error());
  ResidualFields fields = residual_fields(fit);
  ResidualColumns out;
  for (const fit::joint::JointPose& pose : fit.problem.poses) {
    out.pose.push_back(pose.pose);
    out.t_h.push_back(pose.t_h);
  }
  out.columns = extra_columns(out.pose);
  out.residual_nT = residuals_nT(fit);
  out.whitened = std::move(fields.whitened);
  out.scalar_nT = std::move(fields.scalar_nT);
  out.attitude_deg = std::move(fields.attitude_deg);
  out.closure_nT = std::move(fields.closure_nT);
  out.closure_names = std::move(fields.closure_names);
  out.direction_S = std::move(fields.field_S_nT);
  for (Eigen::Index i = 0; i < out.direction_S.rows(); i += 3) {
    out.direction_S.middleRows<3>(i) = out.direction_S.middleRows<3>(i).colwise().normalized().eval();
  }
  hide_left_out(fit, out);
  out.closure_chi2 = closure_chi2(fit, out.closure_nT);
  out.left_out.resize(out.pose.size());
  for (const fit::OutlierNode& node : fit.outliers) out.left_out.at(node.place).push_back(node.where);
  out.influence = *std::move(influence);
  return out;
}

}  // namespace mgtd::calib::criticism::tests
