// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/joint_errors.h"

#include <algorithm>
#include <cmath>

#include "calib/calibration/array_model.h"
#include "calib/fit/joint/cross_validation.h"
#include "calib/fit/joint/pose_residuals.h"
#include "calib/fit/joint/single_samples.h"
#include "calib/fit/joint/without_poses.h"
#include "calib/sensor/sensor_equations.h"

namespace mgtd::calib::fit::joint {
namespace {

struct ErrorSums {
  Eigen::VectorXd field;
  Eigen::Matrix<double, 6, 1> tensor{Eigen::Matrix<double, 6, 1>::Zero()};
  PoseResiduals residuals;
  Eigen::VectorXd fields;
  double tensors{0};

  [[nodiscard]] JointErrors errors(FixedBlock block) const {
    JointErrors out;
    out.summary.total_field_rmse_nT.resize(static_cast<std::size_t>(field.size()));
    for (Eigen::Index i = 0; i < field.size(); ++i)
      out.summary.total_field_rmse_nT[static_cast<std::size_t>(i)] =
          std::sqrt(field[i] / std::max(1.0, fields[i]));
    const Eigen::Matrix<double, 6, 1> g = (tensor / std::max(1.0, tensors)).cwiseSqrt();
    out.summary.tensor_rmse_nT_per_m = {g[0], g[1], g[2], g[3], g[4], g[5]};
    out.residual_nT = block == FixedBlock::fitted ? residuals.residual_nT() : residuals.unseen_nT();
    return out;
  }
};

void add(const JointProblem& problem, const JointState& state, ErrorSums& sums) {
  const calibration::ArrayModel array(state.sensors, problem.geometry, problem.effects, state.coefficients);
  const auto rows = calibration::gradient_rows(problem.geometry);
  const Counted counts = counted(problem);
  if (sums.field.size() == 0) sums.field = sums.fields = Eigen::VectorXd::Zero(problem.sensors());
  for (std::size_t k = 0; k < problem.poses.size(); ++k) {
    const JointPose& pose = problem.poses[k];
    const Nuisance& x = state.nuisances[k];
    const effects::Conditions at = pose.conditions();
    std::optional<Eigen::Matrix3d> R;
    if (pose.has_angles) R = sensor::turn_by<double>(x.head<3>()) * array.attitude(at);
    sensor::FieldVector b = array.correct(at, pose.y_nT, R);
    if (R) b -= array.site_field(at, *R);
    const double f = problem.common_field ? state.f_nT : pose.f_nT;
    const auto at_pose = static_cast<Eigen::Index>(k);
    for (int i = 0; i < problem.sensors(); ++i) {
      if (!counts.field(i, at_pose)) continue;
      sums.field[i] += std::pow(b.segment<3>(3 * i).norm() - f, 2);
      ++sums.fields[i];
    }
    if (!counts.tensor[at_pose]) continue;
    sums.tensor += sensor::over_channels(b.size(), [&](auto n) -> Eigen::Matrix<double, 6, 1> {
      return (rows.leftCols(n) * b.head(n)).cwiseAbs2();
    });
    ++sums.tensors;
  }
  const PoseResiduals more = pose_residuals(problem, state);
  sums.residuals.squares_nT2 += more.squares_nT2;
  sums.residuals.freedom += more.freedom;
  sums.residuals.fitted = more.fitted;
}

/// A problem and the nuisances of its poses: those from..to, or all the others.
struct ProblemPart {
  JointProblem problem;
  std::vector<Nuisance> nuisances;
};

ProblemPart part(const JointFit& fit, std::size_t from, std::size_t to, bool inside) {
  ProblemPart out{without_poses(fit.problem), {}};
  for (std::size_t k = 0; k < fit.problem.poses.size(); ++k) {
    if ((k >= from && k < to) != inside) continue;
    out.problem.poses.push_back(fit.problem.poses[k]);
    out.nuisances.push_back(fit.state.nuisances[k]);
  }
  return out;
}

}  // namespace

Counted counted(const JointProblem& problem) {
  const auto n = static_cast<Eigen::Index>(problem.poses.size());
  Counted out{.field = decltype(Counted::field)(problem.sensors(), n),
              .tensor = decltype(Counted::tensor)(n)};
  for (Eigen::Index k = 0; k < n; ++k) {
    const JointPose& pose = problem.poses[static_cast<std::size_t>(k)];
    out.tensor[k] = true;
    for (int i = 0; i < problem.sensors(); ++i) {
      const bool there = pose.weight.segment<3>(3 * i).minCoeff() > 0;
      out.field(i, k) = there && (pose.f_weight > 0 || pose.reference_weight > 0);
      out.tensor[k] = out.tensor[k] && there;
    }
  }
  return out;
}

JointErrors joint_errors(const JointProblem& problem, const JointState& state, FixedBlock block) {
  ErrorSums sums;
  add(problem, state, sums);
  return sums.errors(block);
}

std::optional<JointErrors> held_out_errors(const JointFit& fit, const Reduced& equations) {
  const std::size_t n = fit.problem.poses.size();
  ErrorSums sums;
  if (fit.problem.sensors() == 1 && is_recording(fit.problem)) {
    // Thousands of samples settle twelve parameters so well that one step is the whole way.
    const bool all = for_each_fold_left_out(
        fit, equations, [&](const JointProblem& fold, const JointState& state) { add(fold, state, sums); });
    return all ? std::optional(sums.errors(FixedBlock::given)) : std::nullopt;
  }
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    const std::size_t from = fold * n / kFolds, to = (fold + 1) * n / kFolds;
    ProblemPart others = part(fit, from, to, false), own = part(fit, from, to, true);
    JointState start = without_poses(fit.state);
    start.nuisances = std::move(others.nuisances);
    auto fitted = solve(others.problem, std::move(start), kNearlyConverged / 1000);
    if (!fitted) return std::nullopt;
    fitted->state.nuisances = std::move(own.nuisances);
    refit_nuisances(own.problem, fitted->state);
    add(own.problem, fitted->state, sums);
  }
  return sums.errors(FixedBlock::given);
}

}  // namespace mgtd::calib::fit::joint
