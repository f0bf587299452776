// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/pose_residuals.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "calib/linear/cholesky4.h"
#include "calib/linear/parts.h"

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
  int attitudes{0}, readings{0}, scalars{0};
  double squares_nT2{0}, all_freedom{0};

  explicit NoiseSums(int sensors) : squares(calibration::AxisNoise::Zero(sensors, 3)), freedom(squares) {}

  void add(const NoiseSums& more) {
    squares += more.squares;
    freedom += more.freedom;
    attitude_squares += more.attitude_squares;
    attitude_trace += more.attitude_trace;
    attitudes += more.attitudes;
    readings += more.readings;
    scalars += more.scalars;
    squares_nT2 += more.squares_nT2;
    all_freedom += more.all_freedom;
  }
};

/// One pose of the sums, and its column of t.
class PoseColumn {
 public:
  PoseColumn(const JointPose& pose, const PoseBlocks& blocks, NoiseSums& sums, Eigen::Ref<Eigen::VectorXf> t)
      : pose_(pose), blocks_(blocks), H_(blocks.H), sums_(sums), t_(t) {}

  void observe_readings() {
    for (int c = 0; c < pose_.y_nT.size(); ++c) {
      if (!(pose_.weight[c] > 0)) continue;
      const double free = freedom(blocks_.N.row(c), H_), residual = blocks_.residual[c];
      sums_.squares(c / 3, c % 3) += residual * residual;
      sums_.freedom(c / 3, c % 3) += free;
      sums_.all_freedom += free;
      ++sums_.readings;
      sums_.squares_nT2 += std::pow(residual / pose_.weight[c], 2);
      if (free > kNothing) t_[c] = static_cast<float>(std::abs(residual) / std::sqrt(free));
    }
  }

  void observe_scalar(bool common_field) {
    if (!(pose_.f_weight > 0) || common_field) return;
    ++sums_.scalars;
    const double free = freedom(blocks_.scalar.nuisance, H_);
    if (free > kNothing)
      t_[t_.size() - 2] = static_cast<float>(std::abs(blocks_.scalar.residual) / std::sqrt(free));
  }

  void observe_attitude(const Nuisance& x) {
    if (!pose_.has_angles || pose_.attitude_weight <= kLooseAttitude_per_rad) return;
    const double w2 = pose_.attitude_weight * pose_.attitude_weight;
    const double posterior =
        w2 * H_.solve(Eigen::Matrix4d(Eigen::Matrix4d::Identity())).diagonal().head<3>().sum();
    const double squares = w2 * x.head<3>().squaredNorm();
    sums_.attitude_squares += squares;
    sums_.attitude_trace += posterior;
    ++sums_.attitudes;
    if (3 - posterior > kNothing)
      t_[t_.size() - 1] = static_cast<float>(std::sqrt(2 * squares / (3 - posterior)));
  }

 private:
  const JointPose& pose_;
  const PoseBlocks& blocks_;
  const linear::Cholesky4 H_;
  NoiseSums& sums_;
  Eigen::Ref<Eigen::VectorXf> t_;
};

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
  std::vector<NoiseSums> parts(linear::parts_of_poses(problem.poses.size()), NoiseSums(problem.sensors()));
  linear::for_each_poses(problem.poses.size(), [&](std::size_t part, std::size_t from, std::size_t to) {
    PoseBlocks b;
    for (std::size_t k = from; k < to; ++k) {
      assemble(problem, model, state, k, Blocks::own, b);
      PoseColumn column(problem.poses[k], b, parts[part], out.t.col(static_cast<Eigen::Index>(k)));
      column.observe_readings();
      column.observe_scalar(problem.common_field);
      column.observe_attitude(state.nuisances[k]);
    }
  });
  NoiseSums sums(problem.sensors());
  for (const NoiseSums& part : parts) sums.add(part);
  out.readings = sums.readings;
  out.scalars = sums.scalars;
  out.squares_nT2 = sums.squares_nT2;
  out.freedom = sums.all_freedom;
  out.noise_ratio.resize(problem.sensors(), 3);
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
