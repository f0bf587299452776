// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/cage.h"

#include <gmock/gmock.h>

#include "tests/rig/pose_writer.h"
#include "tests/rig/simulated_table.h"

namespace mgtd::rig {
namespace {

Scenario in_a_cage(const std::string& reference, const std::string& cage) {
  auto scenario = parse_scenario(
      "[rig]\nparameters = 'ideal'\n[array]\npositions_m = [[0, 0, 0], [0.3, 0, 0]]\n[sensors]\nnoise_nT = "
      "0\n"
      "[reference]\nvector = true\nsd_nT = 0\n" +
          reference + "[cage]\n" + cage,
      "s.toml");
  EXPECT_TRUE(scenario.has_value()) << scenario.error().front();
  return scenario.value_or(Scenario{});
}

Survey survey_of(const Scenario& scenario) {
  return simulated_survey(scenario, cage_fields(*scenario.cage, scenario.seed), scenario.seed);
}

TEST(Cage, ItsFieldsGoFromZeroToFullScaleInAllDirections) {
  for (const std::string fields : {"sphere", "random"}) {
    const Scenario scenario = in_a_cage("", "fields = '" + fields + "'\nmax_nT = 70000\nposes = 200\n");
    const Survey survey = survey_of(scenario);
    ASSERT_EQ(survey.rows.size(), 200U);
    EXPECT_EQ(survey.rows[0].y_nT[0].norm(), 0);
    double largest_nT = 0;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    Eigen::Vector3d middle(0, 0, 0);
    for (const SurveyRow& row : survey.rows) {
      EXPECT_LT((row.y_nT[0] - *row.ref_nT).norm(), 1e-9);
      EXPECT_LT((row.y_nT[1] - *row.ref_nT).norm(), 1e-9);
      largest_nT = std::max(largest_nT, row.y_nT[0].norm());
      const Eigen::Vector3d u = row.y_nT[0].normalized();
      spread += u * u.transpose() / 200;
      middle += u / 200;
    }
    EXPECT_LE(largest_nT, 70'000 + 1e-6) << fields;
    EXPECT_GT(largest_nT, 68'000) << fields;
    const bool even = fields == "sphere";
    EXPECT_LT((spread - Eigen::Matrix3d::Identity() / 3).norm(), even ? 0.01 : 0.15) << fields;
    EXPECT_LT(middle.norm(), even ? 0.01 : 0.2) << fields;
  }
}

TEST(Cage, ItsTableHasNoAngles) {
  const Survey survey = survey_of(in_a_cage("", "poses = 3\n"));
  const std::string text = pose_table_csv(survey);
  EXPECT_EQ(
      text.substr(0, text.find('\n')),
      "pose,set,t_s,n,n_eff,ref_x_nT,ref_y_nT,ref_z_nT,ref_sd_nT,s1_x_nT,s1_y_nT,s1_z_nT,s2_x_nT,s2_y_nT,"
      "s2_z_nT,s1_sd_x_nT,s1_sd_y_nT,s1_sd_z_nT,s2_sd_x_nT,s2_sd_y_nT,s2_sd_z_nT,s1_T_degC,s2_T_degC,"
      "dwell_s");
  EXPECT_EQ(survey.rows[2].set, "cage");
}

/// A scalar magnetometer shows nothing in a small field.
TEST(Cage, TheTotalFieldIsThereWhereItCanBeMeasured) {
  const Survey survey = survey_of(in_a_cage("scalar = true\n", "poses = 40\nmax_nT = 60000\n"));
  for (const SurveyRow& row : survey.rows) {
    EXPECT_EQ(row.f_nT.has_value(), row.y_nT[0].norm() > 20'000);
    if (row.f_nT) {
      EXPECT_NEAR(*row.f_nT, row.y_nT[0].norm(), 0.1);
    }
  }
}

TEST(Cage, TheSiteStaysWithItsGradient) {
  Scenario scenario = in_a_cage("", "poses = 5\n");
  auto with =
      parse_scenario("[[effect]]\nname = 'site.gradient'\nnT_per_m = [50, -20, 15, -25, 10]\n", "s.toml");
  scenario.effects = with.value().effects;
  for (const SurveyRow& row : survey_of(scenario).rows)
    EXPECT_LT((row.y_nT[1] - row.y_nT[0] - 0.3 * Eigen::Vector3d(50, 15, -25)).norm(), 1e-9);
}

}  // namespace
}  // namespace mgtd::rig
