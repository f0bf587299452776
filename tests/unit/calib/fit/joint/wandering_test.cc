// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/wandering.h"

#include <gtest/gtest.h>

#include "calib/fit/joint/joint_report.h"
#include "calib/fit/joint/wandering_estimate.h"
#include "tests/blind/wandering_offsets.h"

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

TEST(Wandering, NothingWandersWithoutTime) { EXPECT_FALSE(WanderingTerms(2, 2).any()); }

WanderingEstimate estimate_of(const PoseTable& table) {
  const auto fit = fit_joint(table, joint_options({}));
  EXPECT_TRUE(fit);
  return estimate_wandering(SlowLikelihood(slow_sums(*fit)));
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
    EXPECT_GT(found.nT_per_sqrt_h.minCoeff(), 0);
    for (int c = 0; c < sensor::kChannels; ++c)
      EXPECT_LT(std::abs(found.nT_per_sqrt_h[c] - kRate), 5 * found.sd[c]) << seed << ' ' << c;
    sum += found.nT_per_sqrt_h.mean();
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
    const auto covariance = covariance_with_wandering(*fit, wandering_of(*fit));
    ASSERT_TRUE(covariance);
    const testing::Rig truth = testing::table6_rig();
    for (int i = 0; i < kSensors; ++i) {
      const auto s = static_cast<std::size_t>(i);
      const sensor::ParameterVector error = fit->state.sensors[s].parameters() - truth[s].parameters();
      const auto square = [&](double by, int p) {
        const int slot = sensor::kSensorParameters * i + p;
        return by * by / (*covariance)(slot, slot);
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

}  // namespace
}  // namespace mgtd::calib::fit::joint
