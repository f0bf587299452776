// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "calib/criticism/rows.h"

/// Takes the four nuisances of every pose out of a linearised joint fit, and the correlation between poses.
///
/// Model of the readings' noise: of each channel first-order autoregressive over the poses in the order of
/// time, n_k = rho n_(k-1) + sqrt(1 - rho^2) e_k; scalar and attitude are independent. Rows of pose k less
/// rho times those of the pose before have independent noise; a sequence of orthogonal transformations then
/// removes the nuisances, pose by pose (a banded QR). What is left are twelve rows a pose with unit
/// independent noise, equivalent to marginalising C_k = Sigma_k + N_k Lambda N_k' exactly, for any rho.
/// A channel whose reading was left out starts its memory anew.
namespace mgtd::calib {

class Whitener {
 public:
  /// `nuisance` as in LinearRows. Poses are taken in the order of their times.
  Whitener(const JointProblem& problem, const Eigen::MatrixXd& nuisance, double rho);

  /// (16 P) x n rows in, (12 P) x n out, blocks of twelve in the order of the poses of the problem.
  [[nodiscard]] Eigen::MatrixXd apply(const Eigen::MatrixXd& rows) const;

  [[nodiscard]] double rho() const { return rho_; }
  /// Observations less nuisances: the rank of what apply() gives.
  [[nodiscard]] int rank() const { return rank_; }
  /// Indices of the poses in the order of time.
  [[nodiscard]] const std::vector<Eigen::Index>& order() const { return order_; }

 private:
  using Square = Eigen::Matrix<double, kPoseRows, kPoseRows>;
  struct Step {
    Eigen::Matrix<double, kChannels, 1> now, before;  ///< factors of this pose's readings and the last one's
    Square first;   ///< carried 4 rows and 12 readings: takes out the nuisances of the pose before
    Square second;  ///< 12 rows that are left and 4 of scalar and attitude: this pose's own
  };
  double rho_;
  int rank_{0};
  std::vector<Eigen::Index> order_;
  std::vector<Step> steps_;
};

/// Poses by time, those of one time in the order of the table.
[[nodiscard]] std::vector<Eigen::Index> order_in_time(const JointProblem& problem);

}  // namespace mgtd::calib
