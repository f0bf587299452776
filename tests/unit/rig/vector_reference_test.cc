// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/vector_reference.h"

#include <gmock/gmock.h>

#include "tests/rig/pose_writer.h"
#include "tests/rig/rotations.h"
#include "tests/rig/simulated_table.h"

namespace mgtd::rig {
namespace {

/// One ideal sensor at the centre: what it reads is b.
Scenario one(const std::string& reference) {
  auto scenario = parse_scenario(
      "[rig]\nparameters = 'ideal'\n[array]\npositions_m = [[0, 0, 0]]\n[sensors]\nnoise_nT = 0\n[table]\n"
      "accuracy_deg = 0\n[reference]\nvector = true\n" +
          reference,
      "s.toml");
  EXPECT_TRUE(scenario.has_value()) << scenario.error().front();
  return scenario.value_or(Scenario{});
}

Survey run(const Scenario& scenario) {
  return simulated_survey(scenario, run_of_157({.random = 20, .revisits = 0}, 1), 1);
}

/// By hand: the reference is turned by 90 degrees about z, so that its x is the platform's y and its y the
/// platform's -x.
TEST(VectorReference, AQuarterTurnIsAQuarterTurn) {
  const VectorReference reference{.misalignment_deg = {0, 0, -90}};
  EXPECT_LT((reference.R() * Eigen::Vector3d(1, 2, 3) - Eigen::Vector3d(-2, 1, 3)).norm(), 1e-14);
}

TEST(VectorReference, OnThePlatformItSeesWhatTheSensorSees) {
  const Scenario scenario = one("sd_nT = 0\nmisalignment_deg = [1, -2, 140]\n");
  const Survey survey = run(scenario);
  const Eigen::Matrix3d R = about_z(140) * about_y(-2) * about_x(1);
  for (const SurveyRow& row : survey.rows) {
    EXPECT_LT((R * *row.ref_nT - row.y_nT[0]).norm(), 1e-6);
    EXPECT_FALSE(row.azimuth_rad.has_value());
    EXPECT_TRUE(row.f_nT.has_value());
  }
}

TEST(VectorReference, BesideTheTableItStandsStill) {
  const Scenario scenario =
      one("sd_nT = 0\nframe = 'site'\nmisalignment_deg = [0.5, 0, 0]\nscalar = false\n");
  const Survey survey = run(scenario);
  for (const SurveyRow& row : survey.rows) {
    const Eigen::Matrix3d A =
        about_z(*row.azimuth_rad / kDeg) * about_y(*row.pitch_rad / kDeg) * about_x(*row.roll_rad / kDeg);
    EXPECT_LT((A * about_x(0.5) * *row.ref_nT - row.y_nT[0]).norm(), 1e-6);
    EXPECT_EQ(*row.ref_nT, *survey.rows[0].ref_nT);
  }
  EXPECT_THAT(
      pose_table_csv(survey),
      ::testing::StartsWith("pose,set,t_s,azimuth_deg,pitch_deg,roll_deg,n,n_eff,ref_x_nT,ref_y_nT,ref_"
                            "z_nT,ref_sd_nT,s1_x_nT,"));
}

/// 4 m to the east in a gradient of 10 nT/m along east; the sensor stays at the centre.
TEST(VectorReference, BesideTheTableItSeesTheFieldOfItsPlace) {
  const std::string gradient =
      "scalar = false\n[[effect]]\nname = 'site.gradient'\nnT_per_m = [0, 10, 0, 0, 0]\n";
  const Survey here = run(one("sd_nT = 0\nframe = 'site'\n" + gradient));
  const Survey there = run(one("sd_nT = 0\nframe = 'site'\nat_m = [0, 4, 0]\n" + gradient));
  for (std::size_t k = 0; k < here.rows.size(); ++k) {
    EXPECT_LT((*there.rows[k].ref_nT - *here.rows[k].ref_nT - Eigen::Vector3d(0, 40, 0)).norm(), 1e-6);
    EXPECT_EQ(there.rows[k].y_nT[0], here.rows[k].y_nT[0]);
  }
}

TEST(VectorReference, ItsNoiseIsAsLargeAsItSays) {
  const Scenario scenario = one("sd_nT = 2\n[cage]\nposes = 1000\n");
  const Survey survey = simulated_survey(scenario, cage_fields(*scenario.cage, 1), 1);
  double squares = 0;
  for (const SurveyRow& row : survey.rows) {
    EXPECT_EQ(*row.ref_sd_nT, 2);
    squares += (*row.ref_nT - row.y_nT[0]).squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(squares / 3000), 2, 0.1);  // 1.3 % one sigma
}

}  // namespace
}  // namespace mgtd::rig
