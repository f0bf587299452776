// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <memory>
#include <vector>

#include "calib/criticism/tests/residual.h"
#include "calib/criticism/tests/rows.h"

/// A Signature is what a law does to the readings of a run: its projected columns z (projection.h), one for
/// each coefficient, in units of the noise. A run of 5832 poses has half a megabyte in each column and the
/// library a thousand of them, so what is held are sums over the rows.
///     z'z = W'W - C'C,   z'r = W'r,   W the whitened rows, C = B'W
/// loses what is below 1e-15 of |W|^2; what is below absorbed^2 = 1e-12 of it says nothing (residual.h).
/// Of a short run the whitened rows are held, else they are made again whenever the columns are asked for.
namespace mgtd::calib::criticism::tests {

class Signature {
 public:
  /// Columns that are projected already, and the residual.
  Signature(Eigen::MatrixXd projected, const Eigen::VectorXd& residual, double absorbed = kAbsorbed);
  /// What `source` refers to must outlive the signature.
  Signature(const Residual& residual, RowSource source);

  [[nodiscard]] Eigen::Index cols() const { return norms_.size(); }
  [[nodiscard]] Eigen::Index rows() const;
  /// Lengths before the model's parameters were taken out.
  [[nodiscard]] const Eigen::VectorXd& norms() const { return norms_; }
  [[nodiscard]] const Eigen::MatrixXd& gram() const { return gram_; }
  /// z'r.
  [[nodiscard]] const Eigen::VectorXd& by_residual() const { return by_residual_; }

  /// Residual::absorbed().
  [[nodiscard]] double absorbed() const { return absorbed_; }

  /// Selects the columns whose length is known to one part in a million: the unit vectors, and zero for those
  /// that the model's parameters take up all but rounding of.
  [[nodiscard]] Eigen::MatrixXd seen() const;

  /// z V: combinations of the columns, whole.
  [[nodiscard]] Eigen::MatrixXd times(const Eigen::MatrixXd& V) const;
  /// z'X of columns X that are projected themselves.
  [[nodiscard]] Eigen::MatrixXd transposed_times(const Eigen::MatrixXd& X) const;

  /// Combinations of the columns of one law.
  struct Combination {
    const Signature* of{nullptr};
    Eigen::MatrixXd V;
  };
  /// Gram matrix of several combinations side by side, all of one residual.
  [[nodiscard]] static Eigen::MatrixXd gram_of(const std::vector<Combination>& all);

 private:
  class Pieces;
  /// Whitened rows, or what is projected already, in the order of the table; empty in a long run.
  std::shared_ptr<const Eigen::MatrixXd> held_;
  std::shared_ptr<const Projection> projection_;  ///< null where held_ is projected already
  RowSource source_;
  double absorbed_;
  Eigen::VectorXd norms_, by_residual_;
  Eigen::VectorXd kept_;  ///< zero for a column that is rounding, else one over the unit
  Eigen::MatrixXd gram_, by_basis_;
};

}  // namespace mgtd::calib::criticism::tests
