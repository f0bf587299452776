// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>

#include "calib/fit/joint_solver.h"

namespace mgtd::calib {
namespace {

constexpr int kBatch =
    32;  ///< poses eliminated per rank update: enough for a blocked product, small enough for the cache

/// Slots that no observation reaches are held by a unit information.
void hold_idle_slots(const JointProblem& problem, Eigen::MatrixXd& S) {
  if (!problem.has_angles) S(kSiteSlot, kSiteSlot) = S(kSiteSlot + 1, kSiteSlot + 1) = 1;
  if (!problem.common_field) S(kFieldSlot, kFieldSlot) = 1;
}

void add_priors(const JointProblem& problem, const JointState& state, Reduced& out) {
  const Eigen::VectorXd x = state.fixed();
  for (const LinearPrior& prior : problem.priors) {
    const double r = prior.weight * (prior.target - prior.row.dot(x));
    out.S.noalias() += prior.weight * prior.weight * prior.row * prior.row.transpose();
    out.g += prior.weight * r * prior.row;
    out.cost.priors += r * r;
  }
  if (!problem.known_direction || !problem.has_angles) return;
  const double w = problem.direction_weight;
  const Eigen::Vector2d r =
      w * tangents(state.direction).transpose() * (*problem.known_direction - state.direction);
  out.S.block<2, 2>(kSiteSlot, kSiteSlot).diagonal().array() += w * w;
  out.g.segment<2>(kSiteSlot) += w * r;
  out.cost.priors += r.squaredNorm();
}

/// The scalar observation: of its own magnetometer, or of the field F common to all poses.
struct ScalarRow {
  double residual;
  Eigen::Matrix<double, 1, kNuisances> nuisance;
  Eigen::RowVectorXd global;
};

ScalarRow scalar_row(const JointProblem& problem, const JointState& state, const JointPose& pose,
                     const PoseLinear& linear) {
  const double w = pose.f_weight;
  const double observed = problem.common_field ? state.f_nT : pose.f_nT;
  ScalarRow row{w * (observed - linear.f_nT), w * linear.f_nuisance, w * linear.f_global};
  if (problem.common_field) row.global[kFieldSlot - kSensorBlock] -= w;
  return row;
}

/// Adds J' J and J' r of the fixed block, reading rows then scalar row, using that a reading sees one sensor
/// only.
void add_fixed(const PoseBlocks& b, const JointPose& pose, const ScalarRow& scalar, Reduced& out) {
  const Eigen::Index globals = b.linear.d_global.cols();
  auto corner = out.S.bottomRightCorner(globals, globals);
  for (int i = 0; i < kSensors; ++i) {
    const auto w = pose.weight.segment<3>(3 * i).asDiagonal();
    const Eigen::Matrix<double, 3, kSensorParameters> A = w * b.linear.d_sensor.middleRows<3>(3 * i);
    const Eigen::Matrix<double, 3, Eigen::Dynamic> G = w * b.linear.d_global.middleRows<3>(3 * i);
    const int at = kSensorParameters * i;
    out.S.block<kSensorParameters, kSensorParameters>(at, at).noalias() += A.transpose() * A;
    out.S.bottomRows(globals).middleCols<kSensorParameters>(at).noalias() += G.transpose() * A;
    corner.noalias() += G.transpose() * G;
    out.g.segment<kSensorParameters>(at).noalias() += A.transpose() * b.residual.segment<3>(3 * i);
    out.g.tail(globals).noalias() += G.transpose() * b.residual.segment<3>(3 * i);
  }
  corner.noalias() += scalar.global.transpose() * scalar.global;
  out.g.tail(globals) += scalar.residual * scalar.global.transpose();
}

}  // namespace

void assemble(const JointProblem& problem, const PoseModel& model, const JointState& state, std::size_t k,
              bool with_border, PoseBlocks& out) {
  const JointPose& pose = problem.poses[k];
  model.linearise(pose, state.nuisances[k], out.linear);
  out.residual = pose.weight.cwiseProduct(pose.y_nT - out.linear.y_nT);
  const ScalarRow scalar = scalar_row(problem, state, pose, out.linear);
  out.f_residual = scalar.residual;
  const Eigen::Matrix<double, kChannels, kNuisances> N = pose.weight.asDiagonal() * out.linear.d_nuisance;
  out.H.noalias() = N.transpose() * N;
  out.H.noalias() += scalar.nuisance.transpose() * scalar.nuisance;
  out.g.noalias() = N.transpose() * out.residual;
  out.g += scalar.residual * scalar.nuisance.transpose();
  out.cost = {.readings = out.residual.squaredNorm(), .scalar = scalar.residual * scalar.residual};
  if (pose.has_angles) {
    const double w2 = pose.attitude_weight * pose.attitude_weight;
    out.H.diagonal().head<3>().array() += w2;
    out.g.head<3>() -= w2 * state.nuisances[k].head<3>();
    out.cost.attitude = w2 * state.nuisances[k].head<3>().squaredNorm();
  } else {
    out.H(3, 3) += 1;  // the idle slot
  }
  if (!with_border) return;
  const Eigen::Index globals = out.linear.d_global.cols();
  out.U.resize(kSensorBlock + globals, kNuisances);
  for (int i = 0; i < kSensors; ++i) {
    const auto w = pose.weight.segment<3>(3 * i).asDiagonal();
    out.U.middleRows<kSensorParameters>(kSensorParameters * i).noalias() =
        (w * out.linear.d_sensor.middleRows<3>(3 * i)).transpose() * N.middleRows<3>(3 * i);
  }
  out.U.bottomRows(globals).noalias() = (pose.weight.asDiagonal() * out.linear.d_global).transpose() * N;
  out.U.bottomRows(globals).noalias() += scalar.global.transpose() * scalar.nuisance;
}

Reduced reduce(const JointProblem& problem, const JointState& state, double damping) {
  const int p = problem.fixed();
  Reduced out{.S = Eigen::MatrixXd::Zero(p, p), .g = Eigen::VectorXd::Zero(p), .cost = {}};
  const PoseModel model(problem, state);
  PoseBlocks b;
  Eigen::MatrixXd batch(p, kBatch * kNuisances);
  int filled = 0;
  const auto flush = [&] {
    out.S.selfadjointView<Eigen::Lower>().rankUpdate(batch.leftCols(filled * kNuisances), -1);
    filled = 0;
  };
  for (std::size_t k = 0; k < problem.poses.size(); ++k) {
    assemble(problem, model, state, k, true, b);
    add_fixed(b, problem.poses[k], scalar_row(problem, state, problem.poses[k], b.linear), out);
    out.cost.readings += b.cost.readings;
    out.cost.scalar += b.cost.scalar;
    out.cost.attitude += b.cost.attitude;
    b.H.diagonal() *= 1 + damping;
    const Eigen::LLT<Eigen::Matrix4d> llt(b.H);
    auto Y = batch.middleCols<kNuisances>(filled * kNuisances);
    Y = llt.matrixL().solve(b.U.transpose()).transpose();
    const Nuisance half = llt.matrixL().solve(b.g);
    out.g.noalias() -= Y * half;
    out.predicted_decrease += half.squaredNorm();
    if (++filled == kBatch) flush();
  }
  flush();
  out.S.triangularView<Eigen::StrictlyUpper>() = out.S.transpose();
  hold_idle_slots(problem, out.S);
  add_priors(problem, state, out);
  out.S.diagonal() *= 1 + damping;
  return out;
}

}  // namespace mgtd::calib
