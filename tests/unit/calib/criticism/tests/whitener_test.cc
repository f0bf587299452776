// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/whitener.h"

#include <gtest/gtest.h>

#include <Eigen/QR>

#include "calib/criticism/tests/noise.h"
#include "calib/criticism/tests/residual.h"
#include "tests/unit/calib/criticism/hidden.h"

namespace mgtd::calib::criticism::tests {
namespace {

using testing::hidden_run;

fit::joint::JointFit fit_of(const PoseTable& table) {
  auto fit = fit::joint::fit_joint(table, {});
  if (!fit) throw std::runtime_error(fit.error().text());
  return std::move(*fit);
}

/// All rows at once: readings of each channel less rho times those before, then least squares over all
/// nuisances.
double dense_chi2(const fit::joint::JointProblem& problem, const LinearRows& rows, double rho) {
  const auto n = static_cast<Eigen::Index>(problem.poses.size());
  Eigen::MatrixXd N = Eigen::MatrixXd::Zero(n * problem.pose_rows(), n * fit::joint::kNuisances);
  for (Eigen::Index k = 0; k < n; ++k) {
    N.block(k * problem.pose_rows(), k * fit::joint::kNuisances, problem.pose_rows(),
            fit::joint::kNuisances) = rows.nuisance.middleRows(k * problem.pose_rows(), problem.pose_rows());
  }
  Eigen::MatrixXd A(N.rows(), N.cols() + 1);
  A << N, rows.residual;
  const Eigen::MatrixXd plain = A;
  for (Eigen::Index k = 1; k < n; ++k) {
    for (int c = 0; c < sensor::kChannels; ++c) {
      A.row(k * problem.pose_rows() + c) =
          (plain.row(k * problem.pose_rows() + c) - rho * plain.row((k - 1) * problem.pose_rows() + c)) /
          std::sqrt(1 - rho * rho);
    }
  }
  const Eigen::VectorXd y = A.rightCols(1);
  const Eigen::MatrixXd X = A.leftCols(N.cols());
  return (y - X * X.colPivHouseholderQr().solve(y)).squaredNorm();
}

TEST(Whitener, EliminatesNuisancesExactlyForAnyCorrelation) {
  PoseTable table = hidden_run({}, 3);
  table.poses.resize(44);  // in the order of time
  const fit::joint::JointFit fit = fit_of(table);
  const LinearRows rows = linear_rows(fit.problem, fit.state);
  for (const double rho : {0.0, 0.3, 0.8}) {
    const Whitener whitener(fit.problem, rows.nuisance, rho);
    EXPECT_NEAR(whitener.apply(rows.residual).squaredNorm(), dense_chi2(fit.problem, rows, rho),
                1e-6 * rows.residual.squaredNorm())
        << rho;
    EXPECT_EQ(whitener.rank(), 44 * sensor::kChannels);
  }
}

/// More poses than are asked for at a time.
TEST(Whitener, TakesRowsWholeOrPieceByPiece) {
  const fit::joint::JointFit fit = fit_of(hidden_run({}, 4));
  const LinearRows rows = linear_rows(fit.problem, fit.state);
  const Whitener whitener(fit.problem, rows.nuisance, 0.4);
  const Eigen::MatrixXd whole = whitener.apply(rows.fixed);
  Eigen::MatrixXd pieces(whole.rows(), whole.cols());
  whitener.apply(fixed_source(fit.problem, fit.state), pieces);
  EXPECT_EQ(whole, pieces);
  EXPECT_EQ(observation_rows(fit.problem, fit.state).nuisance, rows.nuisance);
  EXPECT_EQ(observation_rows(fit.problem, fit.state).fixed.size(), 0);
}

TEST(Whitener, ResidualIsAsLargeAsItsFreedom) {
  // Mean of 8 chi-squares with 1834 degrees of freedom: 1 % one sigma.
  double sum = 0, dof = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const fit::joint::JointFit fit = fit_of(hidden_run({}, 40 + seed));
    const Residual residual(fit.problem, fit.state, 0);
    sum += residual.chi2();
    dof += residual.dof();
  }
  EXPECT_NEAR(sum / dof, 1, 0.04);
}

TEST(Whitener, CorrelationFromPoseToPoseIsEstimatedWithItsMarginAndNoOtherBias) {
  for (const double rho : {0.0, 0.5, 0.8}) {
    double sum = 0;
    constexpr int kRuns = 8;
    for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
      const fit::joint::JointFit fit = fit_of(hidden_run({.rho = rho}, 60 + seed));
      sum += pose_correlation(fit.problem, fit.state) / kRuns;
    }
    // The margin: 1.5 standard errors of a median of twelve channels of 157 poses, where there is a
    // correlation.
    const double margin = rho > 0 ? 1.5 * 1.25 * std::sqrt((1 - rho * rho) / (12 * 157)) : 0;
    // The median scatters by 0.03; at zero it is cut at zero.
    EXPECT_NEAR(sum, rho + margin, 0.04) << rho;
  }
}

}  // namespace
}  // namespace mgtd::calib::criticism::tests
