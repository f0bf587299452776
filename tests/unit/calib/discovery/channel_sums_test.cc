// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/channel_sums.h"

#include <gtest/gtest.h>

#include "calib/criticism/tests/rows.h"
#include "tests/unit/calib/discovery/discovery_scene.h"

namespace mgtd::calib::discovery {
namespace {

LawOnChannels random_law(const ChannelSums& sums, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  LawOnChannels out(static_cast<std::size_t>(sums.total()));
  for (const std::size_t c : {std::size_t{2}, std::size_t{7}, std::size_t{13}})
    out[c] = Eigen::VectorXd::NullaryExpr(sums.poses(), [&] { return normal(rng); });
  return out;
}

/// The same law as rows of the linearised fit, projected by the residual itself.
Eigen::VectorXd projected(const testing::Scene& s, const LawOnChannels& law) {
  const Eigen::MatrixXd gradient = gradient_rows(s.fit.problem, s.fit.state);
  const Eigen::Index block = s.fit.problem.pose_rows();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(gradient.rows(), 1);
  for (std::size_t c = 0; c < law.size(); ++c) {
    for (Eigen::Index k = 0; k < law[c].size(); ++k) {
      const auto channel = static_cast<Eigen::Index>(c);
      if (channel < s.fit.problem.channels()) {
        rows(k * block + channel, 0) +=
            s.fit.problem.poses[static_cast<std::size_t>(k)].weight[channel] * law[c][k];
      } else {
        rows.col(0).segment(k * block, block) +=
            law[c][k] * gradient.col(channel - s.fit.problem.channels()).segment(k * block, block);
      }
    }
  }
  return s.residual.project(rows).projected.col(0);
}

/// White noise, and noise that lasts from pose to pose.
class ChannelSumsOf : public ::testing::TestWithParam<double> {};

TEST_P(ChannelSumsOf, ProductsAreThoseOfTheProjectedSignatures) {
  const auto s = testing::scene({}, 3, GetParam());
  std::mt19937_64 rng(5);
  const LawOnChannels a = random_law(s->sums, rng), b = random_law(s->sums, rng);
  const Eigen::VectorXd za = projected(*s, a), zb = projected(*s, b);
  EXPECT_NEAR(s->sums.product(a, b), za.dot(zb), 1e-8 * za.norm() * zb.norm());
  EXPECT_NEAR(s->sums.product(b, a), za.dot(zb), 1e-8 * za.norm() * zb.norm());
  EXPECT_NEAR(s->sums.by_residual(a), za.dot(s->residual.value()),
              1e-8 * za.norm() * s->residual.value().norm());
}

TEST_P(ChannelSumsOf, ALawThatIsTakenOutIsAParameterOfTheModel) {
  const auto s = testing::scene({}, 3, GetParam());
  std::mt19937_64 rng(6);
  const LawOnChannels taken = random_law(s->sums, rng), a = random_law(s->sums, rng);
  Eigen::VectorXd e = projected(*s, taken).normalized();
  const Eigen::VectorXd z = projected(*s, a), left = z - e * e.dot(z);
  s->sums.take_out(taken);
  EXPECT_NEAR(s->sums.product(taken, taken), 0, 1e-6);
  EXPECT_NEAR(s->sums.product(a, a), left.squaredNorm(), 1e-8 * z.squaredNorm());
  EXPECT_NEAR(s->sums.by_residual(a), left.dot(s->residual.value()), 1e-6 * z.norm());
}

TEST_P(ChannelSumsOf, DrawsHaveTheCovarianceOfTheScores) {
  const auto s = testing::scene({}, 4, GetParam());
  std::mt19937_64 rng(7);
  const LawOnChannels a = random_law(s->sums, rng), b = random_law(s->sums, rng);
  s->sums.take_out(b);
  constexpr Eigen::Index kDraws = 4000;
  std::mt19937_64 random(11);
  const Scores draws = s->sums.scores_of(s->sums.noise(kDraws, random));
  Eigen::RowVectorXd of_a = Eigen::RowVectorXd::Zero(kDraws), of_b = of_a;
  for (std::size_t c = 0; c < a.size(); ++c) {
    if (a[c].size() > 0) of_a += a[c].transpose() * draws[c];
    if (b[c].size() > 0) of_b += b[c].transpose() * draws[c];
  }
  // Variance of a sum of 4000 squares: 2.2 %.
  EXPECT_NEAR(of_a.squaredNorm() / kDraws / s->sums.product(a, a), 1, 0.09);
  EXPECT_NEAR(of_b.squaredNorm() / kDraws, 0, 1e-6 * of_a.squaredNorm() / kDraws);
}

TEST_P(ChannelSumsOf, MomentsAreThoseOfTheWholeMatrix) {
  const auto s = testing::scene({}, 5, GetParam());
  std::mt19937_64 rng(8);
  s->sums.take_out(random_law(s->sums, rng));
  for (int c = 0; c < s->sums.channels(); ++c) {
    const Eigen::MatrixXd G =
        s->sums.product(c, c, Eigen::MatrixXd::Identity(s->sums.poses(), s->sums.poses()));
    const ChannelSums::Moments moments = s->sums.moments(c);
    EXPECT_NEAR(moments.trace, G.trace(), 1e-9 * G.trace());
    EXPECT_NEAR(moments.squares, G.squaredNorm(), 1e-9 * G.squaredNorm());
  }
}

INSTANTIATE_TEST_SUITE_P(Noise, ChannelSumsOf, ::testing::Values(0.0, 0.4));

}  // namespace
}  // namespace mgtd::calib::discovery
