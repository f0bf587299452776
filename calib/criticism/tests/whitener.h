// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "calib/criticism/tests/rows.h"
#include "calib/fit/joint/wandering.h"
#include "calib/linear/product.h"

/// A Whitener takes the four nuisances of every pose, and the correlation between poses, out of a linearised
/// joint fit.
///
/// Model of the readings' noise: of each channel first-order autoregressive over the poses in the order of
/// time, n_k = rho n_(k-1) + sqrt(1 - rho^2) e_k; scalar and attitude are independent. Rows of pose k less
/// rho times those of the pose before have independent noise; a sequence of orthogonal transformations then
/// removes the nuisances, pose by pose (a banded QR). Where rho is zero the nuisances of a pose are in no
/// other's rows and go first. What is left are rows_per_pose() rows for each pose, with unit independent
/// noise, equivalent to marginalising C_k = Sigma_k + N_k Lambda N_k' exactly, for any rho. A channel whose
/// reading was left out starts its memory anew.
///
/// Beside it an offset may wander (wandering.h): o_k = o_(k-1) + a sqrt(t_k - t_(k-1)) e_k. Its value at each
/// pose is one more unknown, and each step a row of its own; both are removed in the same way, exactly.
namespace mgtd::calib::criticism::tests {

class Whitener {
 public:
  /// `nuisance` as in LinearRows; no rates: no offset wanders. Poses are taken in the order of their times.
  Whitener(const fit::joint::JointProblem& problem, const Eigen::MatrixXd& nuisance, double rho,
           const fit::joint::WanderingRates& nT_per_sqrt_h = {});

  /// Rows as in LinearRows in; out, a block of rows_per_pose() for each pose of the problem.
  [[nodiscard]] Eigen::MatrixXd apply(const Eigen::MatrixXd& rows) const;
  void apply(const Eigen::MatrixXd& rows, Eigen::Ref<Eigen::MatrixXd> out) const;
  /// Asks for the rows of a few poses at a time.
  void apply(const RowSource& rows, Eigen::Ref<Eigen::MatrixXd> out) const;

  /// W'X, with W the matrix of apply() and X rows as it gives them: rows as in LinearRows.
  [[nodiscard]] Eigen::MatrixXd apply_transposed(const Eigen::MatrixXd& X) const;

  /// apply(), a pose after the other in order(): holds no more than what one pose hands on to the next.
  class Walk {
   public:
    /// Keeps a reference to the whitener.
    Walk(const Whitener& whitener, Eigen::Index columns);
    /// `rows`: the block of the next pose.
    void next(const Eigen::Ref<const Eigen::MatrixXd>& rows, Eigen::Ref<Eigen::MatrixXd> out);

   private:
    const Whitener& whitener_;
    std::size_t at_{0};
    /// A pose has few rows of many columns: what is done to a row is done to its columns side by side.
    linear::RowByRow given_, own_, in_, turned_, left_, emitted_;
    linear::RowByRow before_;  ///< readings' rows of the last pose
  };

  [[nodiscard]] double rho() const { return rho_; }
  [[nodiscard]] Eigen::Index channels() const { return channels_; }
  /// Of what apply() takes.
  [[nodiscard]] Eigen::Index pose_rows() const { return pose_rows_; }
  /// Of what apply() gives: one for each reading, and one more where the field is known as a vector, or two
  /// less where no attitude is known.
  [[nodiscard]] Eigen::Index rows_per_pose() const { return pose_rows_ - fit::joint::kNuisances; }
  /// ln of the determinant of the covariance of the readings, less that of their weights.
  [[nodiscard]] double log_det() const { return log_det_; }
  [[nodiscard]] bool wanders() const { return !walking_.empty(); }
  /// Observations less nuisances: the rank of what apply() gives.
  [[nodiscard]] int rank() const { return rank_; }
  /// Indices of the poses in the order of time.
  [[nodiscard]] const std::vector<Eigen::Index>& order() const { return order_; }

 private:
  [[nodiscard]] bool remembers() const { return rho_ != 0; }
  [[nodiscard]] Eigen::Index walks() const { return static_cast<Eigen::Index>(walking_.size()); }
  /// Unknowns of a pose that occur in its neighbours' rows, too: offsets that wander, and also its nuisances
  /// where the noise has a memory.
  [[nodiscard]] Eigen::Index unknowns() const { return walks() + (remembers() ? fit::joint::kNuisances : 0); }
  /// Rows of a pose in which unknowns of the pose before occur.
  [[nodiscard]] Eigen::Index coupled() const { return remembers() ? channels_ : 0; }
  /// Rows of a pose after the nuisances that are its alone are taken out.
  [[nodiscard]] Eigen::Index own_rows() const { return remembers() ? pose_rows_ : rows_per_pose(); }
  /// Calls `fill(poses, piece)` with a few poses of order() at a time and copies the piece into `out`.
  void in_pieces(Eigen::Ref<Eigen::MatrixXd> out, const auto& fill) const;
  [[nodiscard]] auto rows_of(std::size_t i, Eigen::MatrixXd& piece) const {
    return piece.middleRows(static_cast<Eigen::Index>(i) * rows_per_pose(), rows_per_pose());
  }
  struct Step {
    Eigen::MatrixXd alone;        ///< takes out the nuisances of the pose; empty where the noise has a memory
    Eigen::VectorXd now, before;  ///< with a memory: factors of this pose's readings and the last one's
    /// Takes out the unknowns of the pose before. Columns: what is handed on, then the coupled rows; those of
    /// the walks' steps are left out, because their data are zero. Empty where poses do not depend on each
    /// other, as is `second`.
    Eigen::MatrixXd first;
    /// What is left, and the other rows: takes out this pose's own.
    Eigen::MatrixXd second;
  };
  double rho_;
  Eigen::Index channels_, pose_rows_;
  std::vector<int> walking_;  ///< channels
  int rank_{0};
  double log_det_{0};
  std::vector<Eigen::Index> order_;
  std::vector<Step> steps_;
};

/// Poses by time, those of one time in the order of the table.
[[nodiscard]] std::vector<Eigen::Index> order_in_time(const fit::joint::JointProblem& problem);

}  // namespace mgtd::calib::criticism::tests
