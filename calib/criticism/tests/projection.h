// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "calib/criticism/tests/whitener.h"

/// A Projection takes out of linearised rows all that a joint fit adjusts: the nuisances of each pose and the
/// correlation between poses (whitener.h), then every direction that the model's own parameters can take,
///     z = (I - B B') W x,   B orthonormal.
namespace mgtd::calib::criticism::tests {

/// Columns shorter than this against their own length before elimination are rounding.
inline constexpr double kRankTolerance = 1e-9;

class Projection {
 public:
  /// Rows of the basis as whitener.apply() gives them, then the priors.
  Projection(Whitener whitener, Eigen::MatrixXd basis);

  [[nodiscard]] const Whitener& whitener() const { return whitener_; }
  [[nodiscard]] const Eigen::MatrixXd& basis() const { return basis_; }

  struct Columns {
    Eigen::MatrixXd projected;
    Eigen::VectorXd norms;  ///< of the columns before the model's parameters were taken out
  };
  /// Rows as effect_rows() gives them.
  [[nodiscard]] Columns project(const Eigen::MatrixXd& rows) const;

 private:
  Whitener whitener_;
  Eigen::MatrixXd basis_;
};

}  // namespace mgtd::calib::criticism::tests
