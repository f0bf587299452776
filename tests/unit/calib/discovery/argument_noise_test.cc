// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/argument_noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proto/units.h"
#include "tests/unit/calib/discovery/discovery_scene.h"

namespace mgtd::calib::discovery {
namespace {

constexpr double kSd_rad = 1e-3;
const Place kOnS2z{Place::Kind::axis, 5};

FittedLaw law_of(const Columns& columns, testing::Scene& scene) {
  FittedLaw law = testing::must(fitted_law(columns, kOnS2z, scene.inputs, scene.sums));
  law.value = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(columns.size()), 5);
  return law;
}

TEST(ArgumentNoise, IsTheSlopeOfTheLawTimesTheUncertaintyOfTheAngle) {
  const auto scene = testing::scene({.noise_nT = 0.05}, 3);
  const FittedLaw law = law_of({"sind(3*azimuth_deg)"}, *scene);
  const Eigen::MatrixXd variance_nT2 = testing::must(variance_of_angles(law, kSd_rad, scene->inputs));
  for (Eigen::Index k = 0; k < scene->inputs.poses(); ++k) {
    const double azimuth_rad = *scene->fit.problem.poses[static_cast<std::size_t>(k)].pose->azimuth_rad;
    const double slope = 5 * 3 * std::cos(3 * azimuth_rad);
    EXPECT_NEAR(variance_nT2(k, 5), slope * slope * kSd_rad * kSd_rad, 1e-8);
  }
  EXPECT_EQ(variance_nT2.leftCols(5).cwiseAbs().maxCoeff(), 0);
  // What was asked of turned angles does not stay.
  EXPECT_EQ(testing::must(fitted_law({"sind(3*azimuth_deg)"}, kOnS2z, scene->inputs, scene->sums)).S, law.S);
}

TEST(ArgumentNoise, AddsTheAnglesOfALawOfSeveral) {
  const auto scene = testing::scene({.noise_nT = 0.05}, 3);
  const auto of = [&](const Columns& columns) {
    return testing::must(variance_of_angles(law_of(columns, *scene), kSd_rad, scene->inputs)).col(5).eval();
  };
  const Eigen::VectorXd both = of({"sind(pitch_deg)", "sind(roll_deg)"});
  EXPECT_LT((both - of({"sind(pitch_deg)"}) - of({"sind(roll_deg)"})).cwiseAbs().maxCoeff(),
            1e-9 * both.maxCoeff());
  EXPECT_GT(both.maxCoeff(), 0);
}

TEST(ArgumentNoise, ALawOfTimeHasNone) {
  const auto scene = testing::scene({.noise_nT = 0.05}, 3);
  EXPECT_EQ(
      testing::must(variance_of_angles(law_of({"t_h", "T_degC"}, *scene), kSd_rad, scene->inputs)).norm(), 0);
}

TEST(ArgumentNoise, WeighsReadingsLessAndLeavesOutWhatWasLeftOut) {
  const auto scene = testing::scene({.noise_nT = 0.05}, 3);
  fit::joint::JointFit fit = scene->fit;
  fit.problem.poses[7].weight[2] = 0;
  Eigen::MatrixXd variance_nT2 = Eigen::MatrixXd::Zero(scene->inputs.poses(), 12);
  const double sd_nT = 1 / fit.problem.poses[4].weight[5];
  variance_nT2(4, 5) = 3 * sd_nT * sd_nT;
  const fit::joint::JointFit out = beside_variance(fit, variance_nT2);
  EXPECT_NEAR(out.problem.poses[4].weight[5] * sd_nT, 0.5, 1e-12);
  EXPECT_NEAR(out.problem.poses[4].weight[4], fit.problem.poses[4].weight[4],
              1e-12 * fit.problem.poses[4].weight[4]);
  EXPECT_EQ(out.problem.poses[7].weight[2], 0);
}

}  // namespace
}  // namespace mgtd::calib::discovery
