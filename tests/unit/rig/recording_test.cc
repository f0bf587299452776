// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/recording.h"

#include <gtest/gtest.h>

#include "tests/rig/pose_writer.h"

namespace mgtd::rig {
namespace {

Scenario recorded(const std::string& more) {
  auto scenario = parse_scenario(
      "[rig]\nparameters = 'ideal'\n[array]\npositions_m = [[0.1, 0, 0], [-0.1, 0, 0]]\n" + more, "s.toml");
  EXPECT_TRUE(scenario.has_value()) << scenario.error().front();
  return scenario.value_or(Scenario{});
}

TEST(Recording, HasOneRowForEachSample) {
  const Scenario scenario = recorded("[recording]\nduration_s = 60\nrate_hz = 20\n");
  const Survey survey = simulated_recording(scenario);
  ASSERT_EQ(survey.rows.size(), 1200U);
  EXPECT_EQ(survey.rows[100].t_s, 5.0);
  const std::string text = pose_table_csv(survey);
  EXPECT_EQ(text.substr(0, text.find('\n')), "pose,t_s,f_nT,s1_x_nT,s1_y_nT,s1_z_nT,s2_x_nT,s2_y_nT,s2_z_nT");
  EXPECT_EQ(text, pose_table_csv(simulated_recording(scenario)));
  Scenario other = scenario;
  other.seed = 2;
  EXPECT_NE(text, pose_table_csv(simulated_recording(other)));
}

TEST(Recording, TellsWhatItIsToldTo) {
  const std::string text =
      pose_table_csv(simulated_recording(recorded("[reference]\nvector = true\n[recording]\nduration_s = 20\n"
                                                  "scalar = false\nangles = true\n")));
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "pose,t_s,azimuth_deg,pitch_deg,roll_deg,ref_x_nT,ref_y_nT,ref_z_nT,ref_sd_nT,s1_x_nT,s1_y_nT,"
            "s1_z_nT,s2_x_nT,s2_y_nT,s2_z_nT");
}

/// Ideal sensors in a uniform field, without noise: its length never changes, while its direction does; and
/// at rest nothing does.
TEST(Recording, TurnsTheFieldAndNothingElse) {
  Scenario scenario = recorded("[sensors]\nnoise_nT = 0\n[recording]\nduration_s = 60\nrate_hz = 10\n");
  const Survey survey = simulated_recording(scenario);
  double turned_nT = 0;
  for (const SurveyRow& row : survey.rows) {
    EXPECT_NEAR(row.y_nT[0].norm(), scenario.f_nT, 1e-6);
    EXPECT_LT((row.y_nT[0] - row.y_nT[1]).norm(), 1e-9);
    turned_nT = std::max(turned_nT, (row.y_nT[0] - survey.rows[0].y_nT[0]).norm());
  }
  EXPECT_GT(turned_nT, scenario.f_nT);
  EXPECT_LT((survey.rows[49].y_nT[0] - survey.rows[0].y_nT[0]).norm(), 1e-6);
  EXPECT_LT((survey.rows[599].y_nT[0] - survey.rows[551].y_nT[0]).norm(), 1e-6);
}

/// At rest what is left of a sample is its noise: 0.3 nT, neighbours correlated as the key says.
TEST(Recording, NoiseIsCorrelatedAsTold) {
  const Survey survey = simulated_recording(
      recorded("[recording]\nmotion = 'level'\nduration_s = 1005\nrest_s = 500\nrate_hz = 10\nar = 0.8\n"));
  double variance = 0, product = 0;
  constexpr int kRows = 4900;
  const Eigen::Vector3d field = [&] {
    Eigen::Vector3d mean(0, 0, 0);
    for (int k = 0; k < kRows; ++k) mean += survey.rows[static_cast<std::size_t>(k)].y_nT[0] / kRows;
    return mean;
  }();
  for (std::size_t k = 0; k + 1 < kRows; ++k) {
    const Eigen::Vector3d here = survey.rows[k].y_nT[0] - field, next = survey.rows[k + 1].y_nT[0] - field;
    variance += here.squaredNorm() / (3 * kRows);
    product += here.dot(next) / (3 * kRows);
  }
  // 14 700 numbers worth 3200 independent ones: 1.3 % one sigma of the sd, 0.005 of the correlation.
  EXPECT_NEAR(std::sqrt(variance), 0.3, 0.02);
  EXPECT_NEAR(product / variance, 0.8, 0.02);
}

TEST(Recording, SixteenSensorsAndEffectsOfTheLastOne) {
  std::string text = "[rig]\nparameters = 'random'\n[array]\npositions_m = [";
  for (int i = 0; i < 16; ++i) text += "[" + std::to_string(0.1 * i) + ", 0, 0],";
  text += "]\n[sensors]\nnoise_nT = 0\n[recording]\nmotion = 'one-axis'\nduration_s = 20\n";
  const Scenario plain = parse_scenario(text, "s.toml").value();
  const Scenario hysteresis =
      parse_scenario(text + "[[effect]]\nname = 'axis.hysteresis'\nwhere = 's16.y'\nh_nT = 8\nwidth = 0.1\n",
                     "s.toml")
          .value();
  const Survey a = simulated_recording(plain), b = simulated_recording(hysteresis);
  double last_nT = 0, others_nT = 0;
  for (std::size_t k = 0; k < a.rows.size(); ++k) {
    for (std::size_t i = 0; i < 16; ++i)
      (i == 15 ? last_nT : others_nT) += (a.rows[k].y_nT[i] - b.rows[k].y_nT[i]).norm();
  }
  EXPECT_GT(last_nT, 1);
  EXPECT_EQ(others_nT, 0);
}

}  // namespace
}  // namespace mgtd::rig
