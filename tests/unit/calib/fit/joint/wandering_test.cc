// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/wandering.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "calib/fit/joint/joint_report.h"
#include "calib/fit/joint/joint_solver.h"
#include "calib/fit/joint/wandering_covariance.h"
#include "calib/linear/parts.h"
#include "tests/blind/wandering_offsets.h"
#include "tests/rig/slow_noise.h"
#include "tests/unit/calib/fit/simulated_poses.h"

namespace mgtd::calib::fit::joint {
namespace {

using testing::hidden_run;
using testing::HiddenRun;
using testing::wandering_offsets;

/// Less its mean, a walk of unit rate over time T has the mean square T/6; 16 terms hold 96 % of it.
TEST(Wandering, ItsTermsHoldNearlyTheWholeWalk) {
  const WanderingTerms terms(-1, 2);
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(kWanderingTerms), square = mean;
  constexpr int kSteps = 3000;
  for (int k = 0; k < kSteps; ++k) {
    const Eigen::VectorXd at = terms.at(-1 + 3 * (k + 0.5) / kSteps);
    mean += at / kSteps;
    square += at.cwiseAbs2() / kSteps;
  }
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_NEAR(square.sum() / (3.0 / 6), 0.963, 0.002);
}

/// 1/f noise of the simulated rig, of unit size, in dwells of 15 s every 30 s: the products of its cosines,
/// and those with the last dwell, are what the terms say, over and above what the faster noise adds to each.
TEST(Wandering, FlickerHasTheTermsOfTheRigs) {
  constexpr int kPoses = 200, kRuns = 2000;
  constexpr double kDwell_s = 15, kLength_h = 2 * kDwell_s * kPoses / 3600;
  const WanderingTerms terms(0, kLength_h, SlowSpectrum::flicker, kPoses);
  Eigen::MatrixXd cosines(kPoses, kWanderingTerms), at(kWanderingTerms, kPoses);
  for (int k = 0; k < kPoses; ++k) {
    const double share = (k + 0.5) / kPoses;
    for (int j = 1; j <= kWanderingTerms; ++j)
      cosines(k, j - 1) = std::numbers::sqrt2 * std::cos(j * std::numbers::pi * share) / kPoses;
    at.col(k) = terms.at(share * kLength_h);
  }
  const Eigen::MatrixXd factor = (at * cosines).transpose();
  Eigen::MatrixXd expected = factor * factor.transpose();
  expected.diagonal().array() += terms.variance_beyond() / kPoses;
  const Eigen::VectorXd expected_by_end = factor * terms.by_end();

  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(kWanderingTerms, kWanderingTerms);
  Eigen::VectorXd by_end = Eigen::VectorXd::Zero(kWanderingTerms), offset(kPoses);
  double end = 0;
  for (int run = 0; run < kRuns; ++run) {
    offset.setZero();
    for (rig::SlowProcess part : rig::flicker(1)) {
      part.begin(random, normal);
      for (double& o : offset) {
        o += part.mean_over(kDwell_s, random, normal);
        part.advance(kDwell_s, random, normal);
      }
    }
    offset.array() -= offset.mean();
    const Eigen::VectorXd z = cosines.transpose() * offset;
    squares += z * z.transpose() / kRuns;
    by_end += z * offset[kPoses - 1] / kRuns;
    end += offset[kPoses - 1] * offset[kPoses - 1] / kRuns;
  }
  // Five standard deviations of a mean of so many products.
  const double most = 5 / std::sqrt(kRuns);
  for (int j = 0; j < kWanderingTerms; ++j) {
    for (int m = 0; m <= j; ++m) {
      const double sd = std::sqrt(expected(j, j) * expected(m, m)) * (j == m ? std::numbers::sqrt2 : 1);
      EXPECT_NEAR(squares(j, m), expected(j, m), most * sd + 0.02 * expected(j, j)) << j << ' ' << m;
    }
    const double sd = std::sqrt(expected(j, j) * terms.variance_at_end());
    EXPECT_NEAR(by_end[j], expected_by_end[j], most * sd) << j;
  }
  EXPECT_NEAR(end, terms.variance_at_end(), most * std::numbers::sqrt2 * terms.variance_at_end());
  EXPECT_NEAR(expected(0, 0), 0.774, 0.02);
}

/// The noise from pose to pose is taken off the covariance of the terms, which must stay positive definite,
/// and what they say of the end of the run must not be more than there is.
TEST(Wandering, FlickerKeepsAPositiveCovarianceHoweverManyPoses) {
  for (std::size_t poses = 0; poses < 30'000; poses += poses < 200 ? 1 : 997) {
    const WanderingTerms terms(0, 1, SlowSpectrum::flicker, poses);
    EXPECT_GT(terms.at(0.3).squaredNorm(), 0.1) << poses;  // not a number where there is no root
    EXPECT_GT(terms.variance_at_end(), terms.by_end().squaredNorm()) << poses;
    EXPECT_GE(terms.variance_beyond(), 0) << poses;
  }
}

TEST(Wandering, NothingWandersWithoutTime) { EXPECT_FALSE(WanderingTerms(2, 2).any()); }

Reduced equations_of(const JointFit& fit) { return reduce(fit.problem, fit.state, 0); }
SlowCosines cosines_of(const JointFit& fit) { return {fit.problem, fit.state}; }
SlowSums sums_of(const JointFit& fit) { return slow_sums(fit, equations_of(fit), cosines_of(fit)); }
WanderingEstimate found_in(const JointFit& fit) {
  return wandering_of(fit, equations_of(fit), cosines_of(fit));
}
Eigen::MatrixXd covariance_with(const WanderingEstimate& wandering, const JointFit& fit) {
  return covariance_with_wandering(fit, equations_of(fit), cosines_of(fit), wandering).value();
}

WanderingEstimate estimate_of(const PoseTable& table) {
  const auto fit = fit_joint(table, joint_options({}));
  EXPECT_TRUE(fit);
  return estimate_wandering(SlowLikelihood(sums_of(*fit)));
}

/// An offset that is shifted by e times one of its terms u changes chi-square, where everything else follows,
/// by 2 e u'r + e^2 u'u. In a run that is summed in several parts none of them may be missing.
TEST(SlowSums, AreWhatChiSquareDoesWhenAnOffsetIsShifted) {
  const PoseTable table = testing::simulate({.rig = testing::table3_rig(), .noise_nT = 0.1}, 36, 2400, 5);
  const auto fit = fit_joint(table, {});
  ASSERT_TRUE(fit) << fit.error().text();
  ASSERT_GT(linear::parts_of_poses(fit->problem.poses.size()), 2U);
  const SlowSums sums = sums_of(*fit);
  const WanderingTerms terms = wandering_terms(fit->problem);
  struct Shift {
    Eigen::Index channel, term;
  };
  for (const Shift shift : {Shift{1, 0}, Shift{8, 3}}) {
    const auto chi2_shifted_by = [&](double nT) {
      JointProblem shifted = fit->problem;
      for (JointPose& pose : shifted.poses) {
        pose.y_nT[shift.channel] += nT * terms.at(pose.t_h)[shift.term];
      }
      const auto solution = solve(shifted, fit->state);
      return solution ? solution->reduced.cost.total() : std::nan("");
    };
    const Eigen::Index column = shift.channel * kWanderingTerms + shift.term;
    // So many nanotesla that the square of a shift is as large as what is left of noise.
    const double e = std::sqrt(sums.chi2 / sums.gram(column, column));
    const double more = chi2_shifted_by(e), less = chi2_shifted_by(-e);
    EXPECT_NEAR((more + less) / 2 - sums.chi2, sums.chi2, 1e-4 * sums.chi2) << column;
    EXPECT_NEAR((more - less) / (4 * e), sums.by_residual[column],
                1e-3 * std::sqrt(sums.gram(column, column)))
        << column;
  }
}

/// A tenth of a nanotesla from pose to pose, half a minute apart.
constexpr double kStep_nT = 0.1;
const double kRate = kStep_nT / std::sqrt(30.0 / 3600);

TEST(WanderingEstimate, FindsTheRateOfAllOffsets) {
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    HiddenRun run{.noise_nT = 0.2};
    run.hidden = wandering_offsets({.step_nT = kStep_nT}, seed);
    const WanderingEstimate found = estimate_of(hidden_run(run, seed));
    ASSERT_EQ(found.where, std::vector<std::string>{"all"});
    EXPECT_GT(found.size.minCoeff(), 0);
    for (int c = 0; c < sensor::kChannels; ++c)
      EXPECT_LT(std::abs(found.size[c] - kRate), 5 * found.sd[c]) << seed << ' ' << c;
    sum += found.size.mean();
  }
  EXPECT_NEAR(sum / 3, kRate, 0.15 * kRate);
}

TEST(WanderingEstimate, NamesTheOneSensor) {
  HiddenRun run{.noise_nT = 0.2};
  run.hidden = wandering_offsets({.step_nT = kStep_nT, .sensor = 1}, 4);
  EXPECT_EQ(estimate_of(hidden_run(run, 4)).where, std::vector<std::string>{"s2"});
}

TEST(WanderingEstimate, FindsNothingInWhiteNoise) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) found += estimate_of(hidden_run({}, seed)).any() ? 1 : 0;
  EXPECT_EQ(found, 0);
}

/// 1/f noise of the simulated rig, the same length of time from pose to pose.
testing::Hidden flickering_offsets(double nT_per_sqrt_hz, std::uint64_t seed) {
  constexpr int kPoses = 200;
  constexpr double kSpacing_s = 30;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  auto at = std::make_shared<std::vector<std::array<double, 12>>>(kPoses);
  for (std::size_t c = 0; c < 12; ++c) {
    std::vector<rig::SlowProcess> parts = rig::flicker(nT_per_sqrt_hz);
    for (rig::SlowProcess& part : parts) part.begin(random, normal);
    for (auto& pose : *at) {
      for (rig::SlowProcess& part : parts) {
        pose.at(c) += part.value_nT();
        part.advance(kSpacing_s, random, normal);
      }
    }
  }
  return [at](const Pose& pose, int sensor, int axis, const Eigen::Vector3d&) {
    return at->at(static_cast<std::size_t>(pose.number)).at(static_cast<std::size_t>(3 * sensor + axis));
  };
}

TEST(WanderingOf, TellsFlickerFromAWalk) {
  constexpr double kSize = 0.05;
  int flicker = 0, walk = 0;
  double size = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    HiddenRun run{.noise_nT = 0.05};
    run.hidden = flickering_offsets(kSize, seed);
    const auto flickers = fit_joint(hidden_run(run, seed), joint_options({}));
    ASSERT_TRUE(flickers);
    const WanderingEstimate found = found_in(*flickers);
    flicker += found.any() && found.spectrum == SlowSpectrum::flicker ? 1 : 0;
    size += found.any() ? found.size.mean() / 6 : 0;
    run.hidden = wandering_offsets({.step_nT = kStep_nT}, seed);
    const auto walks = fit_joint(hidden_run(run, seed), joint_options({}));
    ASSERT_TRUE(walks);
    walk += found_in(*walks).spectrum == SlowSpectrum::walk ? 1 : 0;
  }
  EXPECT_EQ(flicker, 6);
  EXPECT_EQ(walk, 6);
  EXPECT_NEAR(size, kSize, 0.2 * kSize);
}

/// A parameter's square of error over its variance has the mean one where the uncertainty is honest. An
/// offset is asked for at the end of the run.
TEST(CovarianceWithWandering, IsHonest) {
  double scales = 0, offsets = 0;
  int n = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    HiddenRun run{.noise_nT = 0.05};
    run.hidden = wandering_offsets({.step_nT = kStep_nT}, seed);
    const PoseTable table = hidden_run(run, seed);
    const auto fit = fit_joint(table, joint_options({}));
    ASSERT_TRUE(fit);
    const Eigen::MatrixXd covariance = covariance_with(found_in(*fit), *fit);
    const testing::Rig truth = testing::table6_rig();
    for (int i = 0; i < kSensors; ++i) {
      const auto s = static_cast<std::size_t>(i);
      const sensor::ParameterVector error = fit->state.sensors[s].parameters() - truth[s].parameters();
      const auto square = [&](double by, int p) {
        const int slot = sensor::kSensorParameters * i + p;
        return by * by / covariance(slot, slot);
      };
      for (int axis = 0; axis < 3; ++axis, ++n) {
        const double at_end = run.hidden(table.poses.back(), i, axis, {});
        scales += square(error[sensor::cx + axis], sensor::cx + axis);
        offsets += square(error[sensor::ix + axis] - at_end, sensor::ix + axis);
      }
    }
  }
  EXPECT_GT(scales / n, 0.5);
  EXPECT_LT(scales / n, 1.5);
  EXPECT_GT(offsets / n, 0.5);
  EXPECT_LT(offsets / n, 1.5);
}

/// What widens the covariance of a fit whose offsets stay widens this one too.
TEST(CovarianceWithWandering, KeepsTheErrorOfFilledInFieldsAndTheCorrelationOfSamples) {
  HiddenRun run{.noise_nT = 0.05};
  run.hidden = wandering_offsets({.step_nT = kStep_nT}, 3);
  const PoseTable table = hidden_run(run, 3);
  const auto found = fit_joint(table, joint_options({}));
  ASSERT_TRUE(found);
  JointFit fit = *found;
  const WanderingEstimate wandering = found_in(fit);
  const Eigen::MatrixXd plain = covariance_with(wandering, fit);
  fit.problem.filled_in_sd_nT = 5;
  for (JointPose& pose : fit.problem.poses) pose.filled_in = true;
  const Eigen::MatrixXd error = covariance_with(wandering, fit) - plain;
  const double f_nT = fit.state.f_nT;
  for (int i = 0; i < kSensors; ++i) {
    const int slot = sensor::kSensorParameters * i + sensor::cx;
    const double scale = fit.state.sensors[static_cast<std::size_t>(i)].scale[0];
    EXPECT_NEAR(std::sqrt(error(slot, slot)), scale * 5 / f_nT, 0.05 * scale * 5 / f_nT);
  }
  for (JointPose& pose : fit.problem.poses) pose.filled_in = false;
  fit.samples_per_effective = 4;
  const Eigen::MatrixXd correlated = covariance_with(wandering, fit);
  for (int i = 0; i < kSensors; ++i) {
    const int slot = sensor::kSensorParameters * i + sensor::cx;
    EXPECT_GT(correlated(slot, slot), 1.05 * plain(slot, slot));
    EXPECT_LE(correlated(slot, slot), 4 * plain(slot, slot));
  }
}

}  // namespace
}  // namespace mgtd::calib::fit::joint
