// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <functional>
#include <span>

#include "calib/fit/joint/joint_problem.h"

/// linear_rows() writes the linearised joint fit as rows, a block of JointProblem::pose_rows() for each pose,
/// each row divided by its standard deviation (of the cross, with twelve readings):
///     0..11   readings
///     12      scalar reference
///     13..15  attitude; without table angles 13 is the idle slot, and the last
/// With a vector reference 13..15 are its components and 16 is the idle slot; where it stands beside the
/// table, 13..15 are the attitude and 16 is its size.
///
/// An observation that was left out is a row of zeros. Nothing is eliminated here: see whitener.h.
namespace mgtd::calib::criticism::tests {

struct LinearRows {
  Eigen::VectorXd residual;  ///< measured less predicted
  Eigen::MatrixXd fixed;     ///< by the slots of the fixed block
  Eigen::MatrixXd nuisance;  ///< by the pose's own four nuisances
};

[[nodiscard]] LinearRows linear_rows(const fit::joint::JointProblem& problem,
                                     const fit::joint::JointState& state);

/// The same without `fixed`, which of a long run is tens of megabytes.
[[nodiscard]] LinearRows observation_rows(const fit::joint::JointProblem& problem,
                                          const fit::joint::JointState& state);

/// Rows that are made when they are asked for: of a long run no more than a piece is held.
struct RowSource {
  Eigen::Index columns{0};
  /// A block of JointProblem::pose_rows() for each of these poses, in this order.
  std::function<Eigen::MatrixXd(std::span<const Eigen::Index> poses)> of{};
};
/// LinearRows::fixed as a source. Keeps references to problem and state.
[[nodiscard]] RowSource fixed_source(const fit::joint::JointProblem& problem,
                                     const fit::joint::JointState& state);

/// By the coefficients of an effect that is not in the model, at zero. Poses that cannot feed it get zeros.
[[nodiscard]] Eigen::MatrixXd effect_rows(const fit::joint::JointProblem& problem,
                                          const fit::joint::JointState& state,
                                          const effects::EffectPtr& effect);
/// The same at `coefficients`: the shift of a dipole shows only where it has a moment.
[[nodiscard]] Eigen::MatrixXd effect_rows(const fit::joint::JointProblem& problem,
                                          const fit::joint::JointState& state,
                                          const effects::EffectPtr& effect,
                                          const Eigen::VectorXd& coefficients);

/// effect_rows() as a source. Keeps references to problem and state.
[[nodiscard]] RowSource effect_source(const fit::joint::JointProblem& problem,
                                      const fit::joint::JointState& state, const effects::EffectPtr& effect,
                                      const Eigen::VectorXd& coefficients);
[[nodiscard]] RowSource effect_source(const fit::joint::JointProblem& problem,
                                      const fit::joint::JointState& state, const effects::EffectPtr& effect);

/// The priors and gauge constraints of the fixed block, as rows.
struct PriorRows {
  Eigen::VectorXd residual;
  Eigen::MatrixXd fixed;
};
[[nodiscard]] PriorRows prior_rows(const fit::joint::JointProblem& problem,
                                   const fit::joint::JointState& state);

}  // namespace mgtd::calib::criticism::tests
