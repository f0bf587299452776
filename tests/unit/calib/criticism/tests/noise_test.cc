// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/noise.h"

#include <gmock/gmock.h>

#include <cmath>

#include "calib/criticism/search/explain.h"
#include "calib/criticism/tests/comparison.h"
#include "calib/criticism/tests/residual.h"
#include "calib/report/comparison_report.h"
#include "calib/report/noise_text.h"
#include "tests/blind/hidden_run.h"

namespace mgtd::calib::criticism::tests {
namespace {

using ::testing::HasSubstr;
using testing::hidden_run;
using testing::HiddenRun;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kNoise_nT = 0.3;

/// Forty random poses are gone to again, half of all dwells four times as long as the others.
PoseTable with_revisits(const Eigen::Matrix3d& G_nT_per_m, std::uint64_t seed) {
  PoseTable table = hidden_run({.noise_nT = 0, .G_nT_per_m = G_nT_per_m}, seed);
  for (std::size_t k = 0; k < 40; ++k) {
    Pose again = table.poses[60 + k];
    again.number = 1000 + static_cast<int>(k);
    again.t_s = *table.poses.back().t_s + 30;
    table.poses.push_back(std::move(again));
  }
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> normal;
  for (std::size_t k = 0; k < table.poses.size(); ++k) {
    Pose& pose = table.poses[k];
    pose.n = k % 3 == 0 ? 4 : 1;
    for (std::size_t i = 0; i < kSensors; ++i) {
      for (std::size_t a = 0; a < 3; ++a) {
        pose.sd_nT[i][a] = kNoise_nT;
        pose.y_nT[i][static_cast<Eigen::Index>(a)] += kNoise_nT / std::sqrt(*pose.n) * normal(rng);
      }
    }
  }
  return table;
}

double scatter_of_revisits(const PoseTable& table) {
  const auto fit = fit::joint::fit_joint(table, {});
  EXPECT_TRUE(fit);
  const Residual residual(fit->problem, fit->state, 0);
  const auto pure = pure_error(*fit, residual.chi2(), residual.dof());
  EXPECT_TRUE(pure);
  EXPECT_EQ(pure->pairs, 40);
  return pure->ratio;
}

/// Eight combinations a pair: a variance ratio of 320 degrees of freedom, good to 8 %.
TEST(PureError, IsNoiseWhateverTheModelMisses) {
  EXPECT_NEAR(scatter_of_revisits(with_revisits(Eigen::Matrix3d::Zero(), 3)), 1, 0.3);
  EXPECT_NEAR(scatter_of_revisits(with_revisits(testing::gradient_50(), 3)), 1, 0.3);
}

TEST(Residual, IsOneNumberInEveryReport) {
  const PoseTable table = hidden_run(
      {.hidden = [](const Pose& p, int i, int a,
                    const Eigen::Vector3d&) { return i == 2 && a == 2 ? 0.5 * (*p.T_degC[2] - 20) : 0.0; }},
      5);
  const auto compared = compare(table, {});
  const auto explained = search::explain(table, {.fit = {}, .rounds = 0});
  const auto fitted = fit::method_choice::fit(table, {});
  ASSERT_TRUE(compared && explained && fitted);
  EXPECT_NEAR(compared->residual_nT, explained->residual_nT, 1e-9);
  EXPECT_NEAR(compared->residual_nT, fitted->residual_nT, 1e-9);
  EXPECT_DOUBLE_EQ(compared->chi2, explained->chi2);
}

/// 1300 degrees of freedom tell a standard deviation to 2 %.
TEST(Residual, IsTheNoiseWhereTheModelIsComplete) {
  const auto fitted = fit::method_choice::fit(hidden_run({}, 6), {});
  ASSERT_TRUE(fitted);
  EXPECT_NEAR(fitted->residual_nT, kNoise_nT, 0.06 * kNoise_nT);
  ASSERT_TRUE(fitted->held_out_residual_nT);
  EXPECT_NEAR(*fitted->held_out_residual_nT, kNoise_nT, 0.1 * kNoise_nT);
  EXPECT_TRUE(fitted->noise_known);
}

TEST(NoiseText, SaysFromWhatItWasReallyEstimated) {
  const auto clean = compare(hidden_run({}, 6), {});
  ASSERT_TRUE(clean);
  EXPECT_THAT(report::noise_of_tests(clean->noise), IsEmpty());
  EXPECT_THAT(report::to_text(*clean), HasSubstr("from the spread of the samples within the dwells"));
  const auto silent = compare(hidden_run({.spreads = false}, 6), {});
  ASSERT_TRUE(silent);
  EXPECT_THAT(report::to_text(*silent), HasSubstr("estimated from the residual itself"));
  EXPECT_FALSE(silent->log10_p);
  const auto slow = compare(hidden_run({.rho = 0.7}, 6), {});
  ASSERT_TRUE(slow);
  EXPECT_THAT(report::noise_of_tests(slow->noise), HasSubstr("which no dwell can see"));
  const auto cubic = [](const Pose&, int i, int a, const Eigen::Vector3d& v) {
    return i == 1 && a == 0 ? 12 * std::pow(v[0] / 50'000, 3) : 0.0;
  };
  const auto far = compare(hidden_run({.noise_nT = 0.02, .hidden = cubic}, 6), {});
  ASSERT_TRUE(far);
  EXPECT_TRUE(far->noise.known);
  EXPECT_THAT(report::noise_of_tests(far->noise), HasSubstr("far above that noise"));
  EXPECT_THAT(report::to_text(*far), HasSubstr("p < 1e-30"));
}

/// Twice the noise, four times its variance: nu = 18 / (1 - 1/4)^2 = 32, four pairs of eight.
TEST(NoiseText, WithoutRevisitsSaysHowManyWouldTell) {
  NoiseModel noise;
  noise.beyond_dwells = 2;
  EXPECT_THAT(report::noise_of_tests(noise), HasSubstr("visit 4 attitudes twice"));
  noise.beyond_dwells = 1.2;
  EXPECT_THAT(report::noise_of_tests(noise), HasSubstr("visit 25 attitudes twice"));
  noise.revisits = PureError{.pairs = 24};
  EXPECT_THAT(report::noise_of_tests(noise), Not(HasSubstr("attitudes twice")));
}

/// Readings that contradict a vector reference may be right: no other n_eff makes it better.
TEST(NoiseText, AVectorReferenceThatScattersMoreIsSaidToBeIt) {
  NoiseModel noise;
  noise.beyond_dwells = 12;
  noise.vector = {.measured_nT = 0.49, .stated_nT = 0.05, .stated = false, .differs = true};
  EXPECT_THAT(report::noise_of_tests(noise), HasSubstr("give ref_sd_nT = 0.49"));
  EXPECT_THAT(report::noise_of_tests(noise), Not(HasSubstr("n_eff")));
}

TEST(NoiseText, OneAxisThatWandersMayFollowALawOfNoLibrary) {
  NoiseModel noise;
  noise.wandering.evidence = 20;
  noise.wandering.size = noise.wandering.sd = fit::joint::WanderingRates::Zero(sensor::kChannels);
  noise.wandering.size[3] = 1;
  noise.wandering.where = {"s2.x"};
  EXPECT_THAT(report::noise_of_tests(noise), HasSubstr("measure again on another day"));
  noise.wandering.where = {"all"};
  EXPECT_THAT(report::noise_of_tests(noise), Not(HasSubstr("another day")));
}

/// A map with as many columns as there are degrees of freedom leaves nothing to tell the noise from.
TEST(NoiseReference, WithoutDegreesOfFreedomNothingIsImprobable) {
  const NoiseReference own{.known = false, .by_channel = true, .chi2 = 1200, .dof = 1200};
  for (const int k : {100, 120}) EXPECT_EQ(own.log10_p(90, k, 1), 0) << k;
  EXPECT_LT(own.log10_p(90, 10, 1), -10);
}

}  // namespace
}  // namespace mgtd::calib::criticism::tests
