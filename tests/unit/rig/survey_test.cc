// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/survey.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "proto/sha256.h"
#include "tests/rig/effect_list.h"
#include "tests/rig/pose_writer.h"
#include "tests/rig/simulated_table.h"
#include "tests/support/checkout.h"
#include "tests/support/child_process.h"
#include "tests/support/whole_file.h"

namespace mgtd::rig {
namespace {

/// Places of an array that is no cross.
std::vector<Eigen::Vector3d> places(std::size_t sensors) {
  std::vector<Eigen::Vector3d> out;
  for (std::size_t i = 0; i < sensors; ++i) {
    const auto k = static_cast<double>(i);
    out.emplace_back(0.1 * k, 0.2 - 0.05 * k, 0.03 * k * k);
  }
  return out;
}

Scenario ideal(std::size_t sensors) {
  Scenario scenario;
  scenario.truth = rig_named("ideal", 1, sensors).value();
  scenario.positions_m = places(sensors);
  scenario.noise.noise_nT = 0;
  scenario.table_accuracy_deg = 0;
  return scenario;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

TEST(Survey, ItsColumnsAreThoseOfItsSensors) {
  const Design design = run_of_157({.random = 3, .revisits = 0}, 1);
  EXPECT_EQ(first_line(pose_table_csv(simulated_survey(ideal(1), design, 1))),
            "pose,set,t_s,azimuth_deg,pitch_deg,roll_deg,f_nT,f_sd_nT,n,n_eff,s1_x_nT,s1_y_nT,s1_z_nT,"
            "s1_sd_x_nT,s1_sd_y_nT,s1_sd_z_nT,s1_T_degC,sense,dwell_s,since_stop_s");
  EXPECT_EQ(first_line(pose_table_csv(simulated_survey(ideal(2), design, 1))),
            "pose,set,t_s,azimuth_deg,pitch_deg,roll_deg,f_nT,f_sd_nT,n,n_eff,s1_x_nT,s1_y_nT,s1_z_nT,s2_x_"
            "nT,s2_y_nT,s2_z_nT,s1_sd_x_nT,s1_sd_y_nT,s1_sd_z_nT,s2_sd_x_nT,s2_sd_y_nT,s2_sd_z_nT,s1_T_degC,"
            "s2_T_degC,sense,dwell_s,since_stop_s");
  const std::string eight = pose_table_csv(simulated_survey(ideal(8), design, 1));
  EXPECT_THAT(first_line(eight), ::testing::HasSubstr(",s8_x_nT,s8_y_nT,s8_z_nT,s1_sd_x_nT"));
  EXPECT_THAT(first_line(eight), ::testing::HasSubstr(",s8_T_degC,sense"));
  const auto commas = [&](std::size_t from, std::size_t to) {
    return std::count(eight.begin() + static_cast<std::ptrdiff_t>(from),
                      eight.begin() + static_cast<std::ptrdiff_t>(to), ',');
  };
  const std::size_t header = eight.find('\n'), row = eight.find('\n', header + 1);
  EXPECT_EQ(commas(0, header), 10 + 7 * 8 + 3 - 1);
  EXPECT_EQ(commas(header, row), commas(0, header));
}

TEST(Survey, InAUniformFieldAllIdealSensorsReadTheSame) {
  for (const std::size_t sensors : {1U, 2U, 8U, 16U}) {
    const Survey survey = simulated_survey(ideal(sensors), run_of_157({.random = 10, .revisits = 0}, 1), 1);
    for (const SurveyRow& row : survey.rows) {
      ASSERT_EQ(row.y_nT.size(), sensors);
      for (const Eigen::Vector3d& y_nT : row.y_nT) EXPECT_LT((y_nT - row.y_nT[0]).norm(), 1e-9);
      EXPECT_NEAR(row.y_nT[0].norm(), 53'907.7, 1e-6);
    }
  }
}

/// The level pose at azimuth 0: platform and site are parallel, and sensors differ by G x.
TEST(Survey, AGradientOfTheSiteActsAtEachPlace) {
  Scenario scenario = ideal(8);
  scenario.effects.push_back(*effect_of("name = 'site.gradient'\nnT_per_m = [50, -20, 15, -25, 10]"));
  const Eigen::Matrix3d G{{50, 15, -25}, {15, -20, 10}, {-25, 10, -30}};
  const Survey survey = simulated_survey(scenario, run_of_157({.random = 0, .revisits = 0}, 1), 1);
  const std::vector<Eigen::Vector3d>& y_nT = survey.rows[0].y_nT;
  for (std::size_t i = 0; i < 8; ++i) {
    const Eigen::Vector3d expected = G * (scenario.positions_m[i] - scenario.positions_m[0]);
    EXPECT_LT((y_nT[i] - y_nT[0] - expected).norm(), 1e-9) << i;
  }
}

/// No stream of numbers is used twice: neither by two sensors nor by a sensor and another instrument.
TEST(Survey, EverySensorHasNoiseOfItsOwn) {
  Scenario scenario = ideal(16);
  const Design design = run_of_157({.random = 200, .revisits = 0}, 1);
  const Survey quiet = simulated_survey(scenario, design, 1);
  scenario.noise.noise_nT = 0.3;
  const Survey noisy = simulated_survey(scenario, design, 1);
  const auto error = [&](std::size_t row, std::size_t i) {
    return Eigen::Vector3d(noisy.rows[row].y_nT[i] - quiet.rows[row].y_nT[i]);
  };
  for (std::size_t i = 0; i < 16; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double product = 0;
      for (std::size_t k = 0; k < noisy.rows.size(); ++k) product += error(k, i).dot(error(k, j));
      product /= 3 * 0.09 / 200 * static_cast<double>(noisy.rows.size());  // means of 200 and 400 samples
      EXPECT_NEAR(product, i == j ? 0.8 : 0, 0.2) << i << " " << j;        // 708 numbers: 4 % one sigma
    }
  }
}

/// What the program wrote for the cross before it knew of any other array.
TEST(Survey, TheCrossIsWhatItWas) {
  const std::string path = mgtd::testing::source_path("tests/scenarios/paper_experiment.toml");
  const Scenario scenario = parse_scenario(mgtd::testing::whole_file(path), path).value();
  EXPECT_EQ(sha256_hex(truth_json(scenario).dump(1) + "\n"),
            "f5b3dabfdd35a51be0fe96d466039d753878e4562b725c2d154445f789cafe41");
  const Survey survey =
      simulated_survey(scenario, run_of_157({.tilt_limit_deg = scenario.tilt_limit_deg}, 18), 18);
  ASSERT_EQ(survey.rows.size(), 157U);
  const SurveyRow& last = survey.rows[156];
  EXPECT_NEAR(survey.rows[0].y_nT[0][0], 23431.65698, 1e-5);
  EXPECT_NEAR(last.y_nT[3][2], -32878.48436, 1e-5);
  EXPECT_NEAR(*last.t_s, 2112.074, 1e-3);
  EXPECT_NEAR(*last.T_degC[3], 21.3401, 1e-4);
  EXPECT_NEAR(*survey.rows[80].sd_nT[2][1], 0.29344, 1e-5);
  EXPECT_NEAR(*survey.rows[80].f_nT, 53907.7018, 1e-4);
  EXPECT_EQ(sha256_hex(pose_table_csv(survey)), sha256_hex(pose_table_csv(pose_table_of(survey))));
  EXPECT_EQ(first_line(pose_table_csv(survey)),
            "pose,set,t_s,azimuth_deg,pitch_deg,roll_deg,f_nT,f_sd_nT,n,n_eff,s1_x_nT,s1_y_nT,s1_z_nT,s2_x_"
            "nT,s2_y_nT,s2_z_nT,s3_x_nT,s3_y_nT,s3_z_nT,s4_x_nT,s4_y_nT,s4_z_nT,s1_sd_x_nT,s1_sd_y_nT,s1_sd_"
            "z_nT,s2_sd_x_nT,s2_sd_y_nT,s2_sd_z_nT,s3_sd_x_nT,s3_sd_y_nT,s3_sd_z_nT,s4_sd_x_nT,s4_sd_y_nT,s4_"
            "sd_z_nT,s1_T_degC,s2_T_degC,s3_T_degC,s4_T_degC,sense,dwell_s,since_stop_s");
}

TEST(Survey, AnyArrayIsAPoseTable) {
  Survey survey{.sensors = 2, .rows = {}};
  SurveyRow& row = survey.rows.emplace_back(survey.sensors);
  row.y_nT[1] = {1, 2, 3};
  row.ref_nT = Eigen::Vector3d(4, 5, 6);
  const PoseTable table = pose_table_of(survey);
  ASSERT_EQ(table.poses.size(), 1U);
  ASSERT_EQ(table.poses.front().y_nT.size(), 2U);
  EXPECT_EQ(table.poses.front().y_nT[1], Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(table.poses.front().ref_nT, Eigen::Vector3d(4, 5, 6));
}

}  // namespace
}  // namespace mgtd::rig
