// SPDX-License-Identifier: Apache-2.0
// A few seconds of what build/bin/accuracy does at length.
#include "tests/accuracy/campaign.h"

#include <gtest/gtest.h>

#include "tests/accuracy/alarms.h"

namespace mgtd::testing {
namespace {

class Campaign : public ::testing::TestWithParam<bool> {};

TEST_P(Campaign, ReportedCovarianceIsTheRealOne) {
  Scene scene;
  scene.gradient = GetParam();
  const Consistency c = consistency(scene, 80);
  EXPECT_GT(c.nees, c.band_low);
  EXPECT_LT(c.nees, c.band_high);
  // 80 runs of some 20 independent intervals each: 0.5 % one standard deviation.
  EXPECT_NEAR(c.covered, 0.95, 0.02);
}

TEST_P(Campaign, TensorErrorIsNearTheBound) {
  Scene scene;
  scene.gradient = GetParam();
  scene.poses = 500;
  // 60 seeds: a component's rms scatters by some 4 %.
  const TensorErrors e = tensor_errors(scene, 60);
  EXPECT_LT((e.joint / e.bound).maxCoeff(), 1.15);
  EXPECT_GT((e.joint / e.bound).minCoeff(), 0.85);
  EXPECT_GT((e.two_step / e.joint).minCoeff(), 2);
}

INSTANTIATE_TEST_SUITE_P(Gradient, Campaign, ::testing::Bool());

TEST(Campaigns, AWrongBaselineIsCaught) {
  // The gradient comes out ten percent wrong, some fifteen standard errors.
  Scene scene;
  scene.gradient = true;
  scene.site.baseline_m = 0.44;  // the fit believes 0.4
  const Consistency c = consistency(scene, 5);
  EXPECT_GT(c.nees, 2 * c.band_high);
}

TEST(Campaigns, NoiseFromTheDwellsIsAsGood) {
  Scene scene;
  scene.spreads = true;
  const Consistency c = consistency(scene, 60);
  EXPECT_GT(c.nees, c.band_low);
  EXPECT_LT(c.nees, c.band_high);
  const Alarms a = alarms(scene, 40);
  EXPECT_LE(a.false_check, 3);
  EXPECT_LE(a.false_diff, 3);
  EXPECT_NEAR(a.seen_check, 32, 10);
}

TEST(Campaigns, AlarmsAndForecasts) {
  const Alarms a = alarms({}, 40);
  EXPECT_LE(a.false_check, 3);  // 1 %: four or more of 40 in one case of a thousand
  EXPECT_LE(a.false_diff, 3);
  EXPECT_NEAR(a.seen_check, 32, 10);  // binomial standard deviation 2.5
  const Foretold f = foretold({}, 60);
  // Some 20 independent ratios: 1 / sqrt(2 60 20) = 2 % one standard deviation.
  EXPECT_NEAR(f.rms_ratio, 1, 0.07);
  EXPECT_GT(f.lowest, 1 - 4.5 * f.expected_spread);
  EXPECT_LT(f.highest, 1 + 4.5 * f.expected_spread);
}

}  // namespace
}  // namespace mgtd::testing
