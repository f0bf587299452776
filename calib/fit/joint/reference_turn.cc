// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/reference_turn.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "calib/fit/joint/joint_solver.h"
#include "calib/fit/orientation.h"
#include "calib/linear/cholesky.h"
#include "proto/units.h"

namespace mgtd::calib::fit::joint {
namespace {

/// sum T_k e_a r_k' e_b u_k', of which the sums over k for any R_SR are linear combinations.
using Products = std::array<std::array<Eigen::Matrix3d, 3>, 3>;

Products products(const JointProblem& problem, const std::vector<Eigen::Vector3d>& u) {
  Products out;
  for (auto& row : out) row.fill(Eigen::Matrix3d::Zero());
  for (std::size_t k = 0; k < u.size(); ++k) {
    const JointPose& pose = problem.poses[k];
    const Eigen::RowVector3d seen = u[k].normalized().transpose();
    const Eigen::Vector3d r = pose.reference_nT.normalized();
    for (std::size_t a = 0; a < 3; ++a) {
      const Eigen::Matrix3d one = pose.T.col(static_cast<Eigen::Index>(a)) * seen;
      for (std::size_t b = 0; b < 3; ++b) out[a][b] += r[static_cast<Eigen::Index>(b)] * one;
    }
  }
  return out;
}

/// sum T_k R_SR r_k u_k'.
Eigen::Matrix3d for_sensors(const Products& p, const Eigen::Matrix3d& R_SR) {
  Eigen::Matrix3d out = Eigen::Matrix3d::Zero();
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      out += R_SR(a, b) * p[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)];
  return out;
}

/// sum T_k' Q u_k r_k'.
Eigen::Matrix3d for_reference(const Products& p, const Eigen::Matrix3d& Q) {
  Eigen::Matrix3d out;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      out(a, b) = Q.cwiseProduct(p[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)]).sum();
  return out;
}

/// Root mean square of |a_k - R b_k| over pairs of unit vectors, R the best rotation.
double unlike_rad(const Eigen::Matrix3d& sum, double pairs) {
  const double gain = nearest_orthogonal(sum, true).cwiseProduct(sum).sum();
  return std::sqrt(std::max(0.0, 2 * (1 - gain / pairs)));
}

/// Share of the spread of the reference's directions that is more than its noise makes.
double true_spread(const JointProblem& problem) {
  const Eigen::Vector3d mean = mean_reference(problem);
  double spread = 0, noise = 0;
  for (const JointPose& pose : problem.poses) {
    const double w2 = pose.attitude_weight * pose.attitude_weight;
    spread += w2 * (pose.reference_nT.normalized() - mean).squaredNorm();
    noise += w2 * 2 * pose.reference_sd_rad * pose.reference_sd_rad;
  }
  constexpr double kChance = 3;  // standard deviations of the noise's own spread
  const double most = noise * (1 + kChance / std::sqrt(static_cast<double>(problem.poses.size())));
  return spread > most ? 1 - noise / spread : 0;
}

}  // namespace

Eigen::Vector3d mean_reference(const JointProblem& problem) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const JointPose& pose : problem.poses) sum += pose.reference_nT.normalized();
  return sum.stableNormalized();
}

bool keeps_direction(const JointProblem& problem) { return true_spread(problem) == 0; }

Eigen::Matrix3d turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix();
}

ReferencePlacement place_beside(const JointProblem& problem, const std::vector<Eigen::Vector3d>& u) {
  constexpr int kDirections = 200, kTurns = 12, kAlternations = 100;
  constexpr double kSettledTurn_rad = 1e-9;
  /// Of the poses: pulls what they leave open towards where it is.
  constexpr double kStay = 1e-6;
  const Products p = products(problem, u);
  const Eigen::Vector3d mean = mean_reference(problem);
  ReferencePlacement best;
  double best_gain = -1;
  for (int turn = 0; turn < kTurns; ++turn) {
    const Eigen::Matrix3d about =
        Eigen::AngleAxisd(2 * std::numbers::pi * turn / kTurns, mean).toRotationMatrix();
    for (int i = 0; i < kDirections; ++i) {
      const Eigen::Matrix3d R = turn_between(mean, direction_of_sphere(i, kDirections)) * about;
      const Eigen::Matrix3d sum = for_sensors(p, R), Q = nearest_orthogonal(sum, true);
      if (const double gain = Q.cwiseProduct(sum).sum(); gain > best_gain * (1 + 1e-12))
        best_gain = gain, best.Q = Q, best.R_SR = R;
    }
  }
  const auto poses = static_cast<double>(u.size());
  for (int i = 0; i < kAlternations; ++i) {
    const Eigen::Matrix3d before = best.R_SR;
    best.R_SR = nearest_orthogonal(for_reference(p, best.Q) + kStay * poses * before, true);
    best.Q = nearest_orthogonal(for_sensors(p, best.R_SR), true);
    if ((best.R_SR - before).norm() < kSettledTurn_rad) break;
  }
  best.misfit_rad = unlike_rad(for_sensors(p, best.R_SR), poses);
  return best;
}

Result<void> check_reference_stands(const JointProblem& problem, const std::vector<Eigen::Vector3d>& u,
                                    const ReferencePlacement& placement) {
  constexpr double kStands_rad = 0.1, kMuchBetter = 0.1;
  if (placement.misfit_rad < kStands_rad) return {};
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < u.size(); ++k)
    sum += problem.poses[k].reference_nT.normalized() * u[k].normalized().transpose();
  const double turning = unlike_rad(sum, static_cast<double>(u.size()));
  if (turning > kMuchBetter * placement.misfit_rad) return {};
  return fail(
      ErrorCode::refused,
      fmt::format("the vector of the reference turns with the table: it follows the sensors to {:.2g} deg, "
                  "and by the angles of the table to {:.2g} deg",
                  to_deg(turning), to_deg(placement.misfit_rad)),
      "it is in a frame fixed to the sensors: leave the columns azimuth_deg, pitch_deg and roll_deg out");
}

std::optional<double> reference_turn_sd_rad(const JointProblem& problem, const Eigen::MatrixXd& S) {
  constexpr double kKnown_rad = 0.2;
  const double spread = true_spread(problem);
  if (spread == 0) return std::nullopt;
  const auto information = linear::Cholesky::of(S);
  if (!information) return std::nullopt;
  const int slot = problem.slots().field();
  const Eigen::VectorXd one = Eigen::VectorXd::Unit(S.rows(), slot);
  const double own = 1 / information->solve(one)[slot] - 1 / (kFreeTurn_rad * kFreeTurn_rad);
  const double information_of_turn = own * spread;
  if (!(information_of_turn > 1 / (kKnown_rad * kKnown_rad))) return std::nullopt;
  return 1 / std::sqrt(information_of_turn);
}

}  // namespace mgtd::calib::fit::joint
