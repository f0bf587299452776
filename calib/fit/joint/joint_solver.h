// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "calib/fit/joint/joint_limits.h"
#include "calib/fit/joint/joint_problem.h"
#include "calib/fit/joint/pose_model.h"
#include "proto/error.h"

/// solve() finds the least squares of a JointProblem by Gauss-Newton, damped (Levenberg-Marquardt) only where
/// a step fails.
///
/// The Hessian is block bordered, [H_ff U; U' diag(H_k)], with a fixed block (12 parameters of each
/// sensor, those of the site and of the effects) and a 4x4 block per pose. Each pose is eliminated as it is
/// met: S = H_ff - sum U_k H_k^-1 U_k', so memory and time are linear in the poses and nothing per pose is
/// kept but its four nuisances.
namespace mgtd::calib::fit::joint {

/// Chi-squares, kept apart: readings, scalar and vector reference decide about the model, attitude about
/// the table.
struct JointCost {
  double readings{0}, scalar{0}, attitude{0}, priors{0}, reference{0};
  [[nodiscard]] double total() const { return readings + scalar + attitude + priors + reference; }
  /// What decides about the model: all but the table and the priors.
  [[nodiscard]] double of_model() const { return readings + scalar + reference; }
};

/// The scalar observation of a pose, whitened: of its own magnetometer, or of the field F common to all
/// poses.
struct ScalarRow {
  double residual{0};
  Eigen::Matrix<double, 1, kNuisances> nuisance;
  Eigen::RowVectorXd global;
};

/// One pose's share of the normal equations, residuals whitened.
struct PoseBlocks {
  PoseLinear linear;
  Channels residual;  ///< w (measured - predicted)
  ScalarRow scalar;
  sensor::ChannelRows<kNuisances> N;  ///< w dy/d(nuisances)
  /// (w dy/d(parameters))' of each sensor, its own rows.
  PerSensor<Eigen::Matrix<double, sensor::kSensorParameters, 3>> by_sensor;
  Eigen::Matrix<double, kNuisances, kNuisances> H;      ///< of the nuisances
  Nuisance g;                                           ///< descent direction times H: J_n' w^2 (y - y(x))
  Eigen::Matrix<double, Eigen::Dynamic, kNuisances> U;  ///< fixed by nuisances
  JointCost cost;
};

/// How much of PoseBlocks is wanted: what the pose's own unknowns need, the derivatives by the fixed block
/// too (linear.d_sensor, linear.d_global), or by_sensor and U as well. What is not wanted is left without
/// meaning.
enum class Blocks { own, rows, border };

void assemble(const JointProblem& problem, const PoseModel& model, const JointState& state, std::size_t pose,
              Blocks wanted, PoseBlocks& out);

struct Reduced {
  Eigen::MatrixXd S;  ///< information of the fixed block, nuisances eliminated; symmetric
  Eigen::VectorXd g;
  JointCost cost;
  double predicted_decrease{0};  ///< of the cost by the nuisances alone; the fixed block adds g' S^-1 g
};

[[nodiscard]] Reduced reduce(const JointProblem& problem, const JointState& state, double damping);

struct JointSolution {
  JointState state;
  Reduced reduced;  ///< at `state`, undamped
  int iterations{0};
  bool slow_progress{false};  ///< Termination::slow_progress
};

/// Stops at `enough`, of a recording without angles at kRecordingConverged if that is more. Refuses when it
/// does not get there, when a stop is requested (ErrorCode::state), or when the information is not positive
/// definite (which parameters that is about says identifiability.h); `unsettled` then holds how far it came.
[[nodiscard]] Result<JointSolution> solve(const JointProblem& problem, JointState start,
                                          double enough = kConverged, JointState* unsettled = nullptr);

/// Best nuisances for a fixed block that stays as it is: what a new pose says about its own field.
void refit_nuisances(const JointProblem& problem, JointState& state);

}  // namespace mgtd::calib::fit::joint
