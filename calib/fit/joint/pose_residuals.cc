// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/pose_residuals.h"

#include <algorithm>
#include <cmath>

#include "calib/linear/cholesky4.h"

namespace mgtd::calib::fit::joint {
namespace {

/// Share of an observation's freedom below which it has no residual of its own.
constexpr double kNothing = 1e-9;

/// Freedom of an observation: one less its leverage through the pose's own nuisances.
double freedom(const Eigen::Matrix<double, 1, kNuisances>& row, const linear::Cholesky4& H) {
  return std::max(0.0, 1 - H.whitened(row.transpose()).squaredNorm());
}

struct NoiseSums {
  calibration::AxisNoise squares, freedom;
  double attitude_squares{0}, attitude_trace{0};
  int attitudes{0};
};

void observe_readings(const JointPose& pose, const PoseBlocks& b, const linear::Cholesky4& H, Eigen::Index k,
                      NoiseSums& sums, PoseResiduals& out) {
  for (int c = 0; c < pose.y_nT.size(); ++c) {
    if (!(pose.weight[c] > 0)) continue;
    const double free = freedom(b.N.row(c), H);
    sums.squares(c / 3, c % 3) += b.residual[c] * b.residual[c];
    sums.freedom(c / 3, c % 3) += free;
    ++out.readings;
    out.squares_nT2 += std::pow(b.residual[c] / pose.weight[c], 2);
    out.freedom += free;
    if (free > kNothing) out.t(c, k) = static_cast<float>(std::abs(b.residual[c]) / std::sqrt(free));
  }
}

void observe_scalar(const JointProblem& problem, const JointPose& pose, const PoseBlocks& b,
                    const linear::Cholesky4& H, Eigen::Index k, PoseResiduals& out) {
  if (!(pose.f_weight > 0) || problem.common_field) return;
  ++out.scalars;
  const double free = freedom(b.scalar.nuisance, H);
  if (free > kNothing)
    out.t(out.scalar_row(), k) = static_cast<float>(std::abs(b.scalar.residual) / std::sqrt(free));
}

void observe_attitude(const JointPose& pose, const Nuisance& x, const linear::Cholesky4& H, Eigen::Index k,
                      NoiseSums& sums, PoseResiduals& out) {
  if (!pose.has_angles || pose.attitude_weight <= kLooseAttitude_per_rad) return;
  const double w2 = pose.attitude_weight * pose.attitude_weight;
  const double posterior =
      w2 * H.solve(Eigen::Matrix4d(Eigen::Matrix4d::Identity())).diagonal().head<3>().sum();
  const double squares = w2 * x.head<3>().squaredNorm();
  sums.attitude_squares += squares;
  sums.attitude_trace += posterior;
  ++sums.attitudes;
  if (3 - posterior > kNothing)
    out.t(out.attitude_row(), k) = static_cast<float>(std::sqrt(2 * squares / (3 - posterior)));
}

/// Freedom of all attitudes together: the posterior traces leave 2 a pose where the prior is weak, and the
/// common rotation (3) and the site direction (2) are fitted to them.
double attitude_freedom(const NoiseSums& sums) {
  const double free = 3.0 * sums.attitudes - sums.attitude_trace;
  return sums.attitudes == 0 ? 0 : std::max(0.0, free * (1 - 5.0 / (2.0 * sums.attitudes)));
}

}  // namespace

double PoseResiduals::residual_nT() const { return std::sqrt(squares_nT2 / std::max(1.0, freedom - fitted)); }
double PoseResiduals::unseen_nT() const { return std::sqrt(squares_nT2 / std::max(1.0, freedom)); }

PoseResiduals pose_residuals(const JointProblem& problem, const JointState& state) {
  PoseResiduals out;
  out.t.setZero(problem.channels() + 2, static_cast<Eigen::Index>(problem.poses.size()));
  const PoseModel model(problem, state);
  PoseBlocks b;
  NoiseSums sums;
  sums.squares = sums.freedom = calibration::AxisNoise::Zero(problem.sensors(), 3);
  out.noise_ratio.resize(problem.sensors(), 3);
  for (std::size_t k = 0; k < problem.poses.size(); ++k) {
    assemble(problem, model, state, k, Blocks::own, b);
    const linear::Cholesky4 H(b.H);
    const auto at = static_cast<Eigen::Index>(k);
    observe_readings(problem.poses[k], b, H, at, sums, out);
    observe_scalar(problem, problem.poses[k], b, H, at, out);
    observe_attitude(problem.poses[k], state.nuisances[k], H, at, sums, out);
  }
  // Each reading is an affine form of the field: four unknowns of the fixed block a channel, and its share of
  // effects.
  const double fitted = 4.0 + problem.coefficients() / static_cast<double>(problem.channels());
  out.fitted = problem.channels() * fitted;
  for (int i = 0; i < problem.sensors(); ++i) {
    for (int a = 0; a < 3; ++a) {
      const double free = sums.freedom(i, a) - fitted;
      out.noise_ratio(i, a) = free > 1 ? std::sqrt(sums.squares(i, a) / free) : 1;
    }
  }
  out.attitude_freedom = attitude_freedom(sums);
  if (out.attitude_freedom > 1) out.table_ratio = std::sqrt(sums.attitude_squares / out.attitude_freedom);
  return out;
}

}  // namespace mgtd::calib::fit::joint
