// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/residual_fields.h"

#include <fmt/format.h>

#include <Eigen/LU>

#include "calib/calibration/tensor.h"
#include "proto/units.h"

namespace mgtd::calib::criticism::tests {
namespace {

void fill_closure(const sensor::Geometry& geometry, ResidualFields& out) {
  out.closure_nT = calibration::closure_rows(geometry) * out.delta_nT;
  if (const auto baseline_m = geometry.cross_baseline_m()) {
    out.closure_nT.row(0) *= *baseline_m;
    out.closure_names = {"curl", "center x", "center y", "center z"};
    return;
  }
  for (Eigen::Index i = 0; i < out.closure_nT.rows(); ++i)
    out.closure_names.push_back(fmt::format("combination {}", i + 1));
}

}  // namespace

ResidualFields residual_fields(const fit::joint::JointFit& fit) {
  const auto n = static_cast<Eigen::Index>(fit.problem.poses.size());
  const int sensors = fit.problem.sensors(), channels = fit.problem.channels();
  ResidualFields out{.whitened = Eigen::MatrixXd(channels, n),
                     .delta_nT = Eigen::MatrixXd(channels, n),
                     .scalar_nT = Eigen::MatrixXd(sensors, n),
                     .attitude_deg = Eigen::MatrixXd::Zero(3, n),
                     .closure_nT = {},
                     .closure_names = {},
                     .field_S_nT = Eigen::MatrixXd(channels, n)};
  const fit::joint::PoseModel model(fit.problem, fit.state);
  fit::joint::PoseLinear linear;
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const fit::joint::JointPose& pose = fit.problem.poses[at];
    model.linearise(pose, fit.state.nuisances[at], linear);
    const fit::joint::Channels e = (pose.weight.array() > 0).select(pose.y_nT - linear.y_nT, 0.0);
    out.whitened.col(k) = fit.noise_inflation * pose.weight.cwiseProduct(e);
    const double field = fit.problem.common_field ? fit.state.f_nT : pose.f_nT;
    for (int i = 0; i < sensors; ++i) {
      const sensor::SensorModel& s = fit.state.sensors[static_cast<std::size_t>(i)];
      const Eigen::Vector3d b = s.correct(linear.y_nT.segment<3>(3 * i));
      const Eigen::Vector3d delta = s.R_PS() * (s.response().inverse() * e.segment<3>(3 * i));
      out.delta_nT.block<3, 1>(3 * i, k) = delta;
      out.scalar_nT(i, k) = b.normalized().dot(delta) + linear.f_nT - field;
      out.field_S_nT.block<3, 1>(3 * i, k) = s.R_PS().transpose() * b;
    }
    if (pose.has_angles) out.attitude_deg.col(k) = fit.state.nuisances[at].head<3>() * to_deg(1);
  }
  fill_closure(fit.problem.geometry, out);
  return out;
}

}  // namespace mgtd::calib::criticism::tests
