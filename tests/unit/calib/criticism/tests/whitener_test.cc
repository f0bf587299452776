// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/whitener.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <string>
#include <vector>

#include "calib/criticism/tests/noise.h"
#include "calib/criticism/tests/residual.h"
#include "tests/unit/calib/criticism/hidden.h"
#include "tests/unit/calib/fit/arrays_of_any_size.h"

namespace mgtd::calib::criticism::tests {
namespace {

using testing::hidden_run;

fit::joint::JointFit fit_of(const PoseTable& table) {
  auto fit = fit::joint::fit_joint(table, {});
  if (!fit) throw std::runtime_error(fit.error().text());
  return std::move(*fit);
}

/// All rows at once, against all unknowns at once: readings of each channel less rho times those before, and
/// the steps of the walks. -2 ln of the likelihood without the weights, by its quadratic form and its
/// determinant.
struct Dense {
  double chi2{0}, log_det{0};
};

Dense dense(const fit::joint::JointProblem& problem, const LinearRows& rows, double rho,
            const fit::joint::WanderingRates& nT_per_sqrt_h) {
  constexpr double kStart_nT = 1e-4;  // a walk begins at nothing
  const auto n = static_cast<Eigen::Index>(problem.poses.size());
  const Eigen::Index block = problem.pose_rows(), channels = problem.channels();
  std::vector<Eigen::Index> walks;
  for (Eigen::Index c = 0; c < nT_per_sqrt_h.size(); ++c)
    if (nT_per_sqrt_h[c] > 0) walks.push_back(c);
  const auto W = static_cast<Eigen::Index>(walks.size()), of_pose = fit::joint::kNuisances + W;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n * (block + W), n * of_pose + 1);
  double log_steps = 0;
  for (Eigen::Index k = 0; k < n; ++k) {
    const fit::joint::JointPose& pose = problem.poses[static_cast<std::size_t>(k)];
    A.block(k * block, k * of_pose, block, fit::joint::kNuisances) =
        rows.nuisance.middleRows(k * block, block);
    A.col(n * of_pose).segment(k * block, block) = rows.residual.segment(k * block, block);
    for (Eigen::Index i = 0; i < W; ++i) {
      const Eigen::Index c = walks[static_cast<std::size_t>(i)],
                         at = k * of_pose + fit::joint::kNuisances + i;
      A(k * block + c, at) = pose.weight[c];
      const Eigen::Index row = n * block + k * W + i;
      if (k == 0) {
        A(row, at) = 1 / kStart_nT;
        continue;
      }
      const double hours = pose.t_h - problem.poses[static_cast<std::size_t>(k - 1)].t_h;
      A(row, at) = 1 / (nT_per_sqrt_h[c] * std::sqrt(hours));
      A(row, at - of_pose) = -A(row, at);
      log_steps += std::log(A(row, at));
    }
  }
  const Eigen::MatrixXd plain = A;
  for (Eigen::Index k = 1; k < n; ++k) {
    for (Eigen::Index c = 0; c < channels; ++c) {
      const auto at = static_cast<std::size_t>(k);
      if (problem.poses[at].weight[c] == 0 || problem.poses[at - 1].weight[c] == 0) continue;
      A.row(k * block + c) =
          (plain.row(k * block + c) - rho * plain.row((k - 1) * block + c)) / std::sqrt(1 - rho * rho);
    }
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A.leftCols(n * of_pose));
  const Eigen::VectorXd y = A.rightCols(1);
  return {.chi2 = (y - A.leftCols(n * of_pose) * qr.solve(y)).squaredNorm(),
          .log_det =
              2 * qr.matrixR().diagonal().head(n * of_pose).cwiseAbs().array().log().sum() - 2 * log_steps};
}

struct Case {
  const char* name;
  PoseTable table;
  std::vector<Eigen::Vector3d> places;
};

PoseTable without_angles(PoseTable table) {
  for (Pose& pose : table.poses) pose.azimuth_rad = pose.pitch_rad = pose.roll_rad = std::nullopt;
  return table;
}

PoseTable with_some_angles(PoseTable table) {
  for (std::size_t k = 0; k < table.poses.size(); k += 3) table.poses[k].azimuth_rad = std::nullopt;
  return table;
}

/// Against the dense solution, whatever the order in which the poses stand.
void expect_exact(fit::joint::JointFit fit, double rho, const fit::joint::WanderingRates& rates,
                  const std::string& at) {
  const LinearRows rows = linear_rows(fit.problem, fit.state);
  const Dense expected = dense(fit.problem, rows, rho, rates);
  const double length2 = rows.residual.squaredNorm();
  for (const bool reversed : {false, true}) {
    if (reversed) {
      std::reverse(fit.problem.poses.begin(), fit.problem.poses.end());
      std::reverse(fit.state.nuisances.begin(), fit.state.nuisances.end());
    }
    const LinearRows now = linear_rows(fit.problem, fit.state);
    const Whitener whitener(fit.problem, now.nuisance, rho, rates);
    const Eigen::MatrixXd white = whitener.apply(now.residual);
    EXPECT_NEAR(white.squaredNorm(), expected.chi2, 1e-6 * length2) << at;
    EXPECT_NEAR(whitener.log_det(), expected.log_det, 1e-6 * std::abs(expected.log_det)) << at;
    ASSERT_EQ(white.rows(), static_cast<Eigen::Index>(fit.problem.poses.size()) * whitener.rows_per_pose());
    const Eigen::MatrixXd some =
        Eigen::VectorXd::LinSpaced(3 * white.rows(), 0, 40).array().sin().matrix().reshaped(white.rows(), 3);
    EXPECT_TRUE(
        (some.transpose() * white).isApprox(whitener.apply_transposed(some).transpose() * now.residual, 1e-9))
        << at;
  }
}

TEST(Whitener, EliminatesWhatAPoseMayTakeExactlyForAnyMemoryAndAnyWalk) {
  const testing::Places cross = testing::cross_of_four(), one = testing::one_sensor();
  const PoseTable of_cross = testing::turned_run(cross, 4), of_one = testing::turned_run(one, 6);
  for (const auto& [name, table, places] :
       {Case{"cross", hidden_run({}, 3), cross},
        Case{"cross without attitudes", without_angles(of_cross), cross},
        Case{"cross with some attitudes", with_some_angles(of_cross), cross},
        Case{"one sensor", testing::turned_run(one, 5), one},
        Case{"one sensor in a known field",
             without_angles(testing::turned_run(one, 7, "[reference]\nvector = true\nangles = false\n")),
             one},
        Case{"one sensor without attitudes", without_angles(of_one), one}}) {
    fit::joint::JointOptions options;
    options.geometry = testing::geometry_of(places);
    auto fit = fit::joint::fit_joint(table, options);
    ASSERT_TRUE(fit) << name << ": " << fit.error().text();
    constexpr std::size_t kPoses = 20;  // in the order of time
    fit->problem.poses.resize(kPoses), fit->state.nuisances.resize(kPoses);
    const Eigen::Index channels = fit->problem.channels();
    fit::joint::WanderingRates one_axis = fit::joint::WanderingRates::Zero(channels), all = one_axis;
    one_axis[1] = 2;
    all.setLinSpaced(channels, 0.3, 3);
    for (const fit::joint::WanderingRates& rates : {fit::joint::WanderingRates(), one_axis, all})
      for (const double rho : {0.0, 0.3, 0.8})
        expect_exact(*fit, rho, rates,
                     fmt::format("{}, rho {}, {} walk", name, rho, (rates.array() > 0).count()));
    if (channels == 3) continue;  // a pose of one sensor needs its three readings
    fit->problem.poses[7].weight[1] = 0;
    for (const double rho : {0.0, 0.3})
      expect_exact(*fit, rho, one_axis, fmt::format("{}, one left out", name));
  }
}

TEST(Whitener, RankIsReadingsAndReferencesLessUnknowns) {
  PoseTable table = hidden_run({}, 3);
  table.poses.resize(44);
  const fit::joint::JointFit fit = fit_of(table);
  EXPECT_EQ(Whitener(fit.problem, linear_rows(fit.problem, fit.state).nuisance, 0.3).rank(),
            44 * sensor::kChannels);
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
