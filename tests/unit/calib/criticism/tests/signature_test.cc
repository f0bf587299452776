// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/signature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "calib/criticism/tests/residual.h"
#include "calib/effects/library/library.h"
#include "tests/unit/calib/criticism/hidden.h"
#include "tests/unit/calib/criticism/synthetic_families.h"

namespace mgtd::calib::criticism::tests {
namespace {

/// A run again and again: long enough that its columns are not held.
PoseTable repeated(const PoseTable& once, int times) {
  PoseTable out = once;
  out.poses.clear();
  const double long_s = 60 + *once.poses.back().t_s - *once.poses.front().t_s;
  for (int i = 0; i < times; ++i) {
    for (Pose pose : once.poses) {
      pose.t_utc.reset();
      pose.number += i * static_cast<int>(once.poses.size());
      *pose.t_s += i * long_s;
      out.poses.push_back(std::move(pose));
    }
  }
  return out;
}

fit::joint::JointFit fit_of(const PoseTable& table) {
  auto fit = fit::joint::fit_joint(table, {});
  if (!fit) throw std::runtime_error(fit.error().text());
  return std::move(*fit);
}

effects::EffectPtr effect(const char* spec) { return effects::library::make_effect(spec).value(); }

/// One axis wanders, and the noise of all is correlated from pose to pose.
Residual residual_of(const fit::joint::JointFit& fit) {
  fit::joint::WanderingRates rates = fit::joint::WanderingRates::Zero(fit.problem.channels());
  rates[4] = 2;
  Residual out(fit.problem, fit.state, 0.3, rates);
  out.measure_by(1.7);
  return out;
}

/// 157 poses, whose rows are held, and 1099, whose rows are made again when they are asked for.
class SignatureOf : public ::testing::TestWithParam<int> {
 protected:
  const PoseTable table_ = repeated(testing::hidden_run({}, 3), GetParam());
  const fit::joint::JointFit fit_ = fit_of(table_);
  const Residual residual_ = residual_of(fit_);
  const effects::EffectPtr drift_ = effect("axis.offset.drift@each-axis"),
                           gradient_ = effect("site.gradient");

  [[nodiscard]] Signature signature(const effects::EffectPtr& law) const {
    return {residual_, effect_source(fit_.problem, fit_.state, law)};
  }
  [[nodiscard]] Eigen::MatrixXd projected(const effects::EffectPtr& law) const {
    return residual_.project(effect_rows(fit_.problem, fit_.state, law)).projected;
  }
};

TEST_P(SignatureOf, ItsSumsAreThoseOfTheProjectedColumns) {
  for (const effects::EffectPtr& law : {drift_, gradient_}) {
    const Signature s = signature(law);
    const Eigen::MatrixXd z = projected(law);
    EXPECT_TRUE(s.gram().isApprox(z.transpose() * z, 1e-9));
    EXPECT_TRUE(s.by_residual().isApprox(z.transpose() * residual_.value(), 1e-9));
    EXPECT_TRUE(
        s.norms().isApprox(residual_.project(effect_rows(fit_.problem, fit_.state, law)).norms, 1e-12));
    EXPECT_EQ(s.rows(), z.rows());
  }
}

TEST_P(SignatureOf, CombinationsAreThoseOfTheProjectedColumns) {
  const Signature s = signature(drift_);
  const Eigen::MatrixXd z = projected(drift_);
  Eigen::MatrixXd V = Eigen::MatrixXd::Zero(s.cols(), 2);
  V(3, 0) = 1, V(7, 0) = -2, V(11, 1) = 0.5;
  EXPECT_TRUE(s.times(V).isApprox(z * V, 1e-9));
  const Eigen::MatrixXd X = projected(gradient_);
  EXPECT_TRUE(s.transposed_times(X).isApprox(z.transpose() * X, 1e-8));
}

TEST_P(SignatureOf, TheGramMatrixOfSeveralLawsIsThatOfTheirColumnsSideBySide) {
  const Signature a = signature(drift_), b = signature(gradient_);
  const Eigen::MatrixXd V = Eigen::MatrixXd::Identity(a.cols(), 3),
                        W = Eigen::MatrixXd::Identity(b.cols(), b.cols());
  Eigen::MatrixXd all(a.rows(), 3 + b.cols() + 1);
  all << projected(drift_) * V, projected(gradient_), projected(drift_).col(5);
  const Eigen::MatrixXd gram =
      Signature::gram_of({{&a, V}, {&b, W}, {&a, Eigen::MatrixXd::Identity(a.cols(), a.cols()).col(5)}});
  EXPECT_TRUE(gram.isApprox(all.transpose() * all, 1e-9));
}

INSTANTIATE_TEST_SUITE_P(RunsOf, SignatureOf, ::testing::Values(1, 7));

/// y'(W x) = (W'y)'x.
TEST(Whitener, ItsTransposeIsItsTranspose) {
  const fit::joint::JointFit fit = fit_of(testing::hidden_run({}, 3));
  const LinearRows rows = linear_rows(fit.problem, fit.state);
  std::mt19937_64 random(5);
  fit::joint::WanderingRates rates = fit::joint::WanderingRates::Zero(fit.problem.channels());
  for (const double nT_per_sqrt_h : {0.0, 2.0}) {
    rates[1] = nT_per_sqrt_h;
    for (const double rho : {0.0, 0.4}) {
      const Whitener whitener(fit.problem, rows.nuisance, rho, rates);
      const Eigen::VectorXd x = testing::normal(rows.residual.size(), random);
      const Eigen::VectorXd Wx = whitener.apply(x), y = testing::normal(Wx.size(), random);
      EXPECT_NEAR(y.dot(Wx), whitener.apply_transposed(y).col(0).dot(x), 1e-9 * y.norm() * Wx.norm())
          << rho << ' ' << nT_per_sqrt_h;
    }
  }
}

}  // namespace
}  // namespace mgtd::calib::criticism::tests
