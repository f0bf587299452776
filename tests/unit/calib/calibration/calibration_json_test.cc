// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration/calibration_json.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>

namespace mgtd::calib::calibration {
namespace {

using ::testing::HasSubstr;

Calibration random_calibration(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Calibration c;
  c.method = "two-step";
  for (sensor::SensorModel& sensor : c.sensors) {
    sensor::ParameterVector p;
    for (double& value : p) value = normal(random);
    sensor = sensor::SensorModel::from_parameters(p);
  }
  c.sensors[2].mounting << 0, -1, 0, 0, 0, 1, -1, 0, 0;
  Eigen::MatrixXd half(kArrayParameters, kArrayParameters);
  for (double& value : half.reshaped()) value = 1e-5 * normal(random);
  c.covariance = half * half.transpose();
  c.covariance = 0.5 * (c.covariance + c.covariance.transpose()).eval();
  c.geometry = sensor::Geometry(0.4 + 1e-3 * normal(random));
  c.sample_noise_nT.setConstant(0.1 / 3);
  c.pose_noise_nT.setConstant(1.0 / 7);
  c.gauge = "platform frame is the table frame; \"quoted\" and ±";
  c.reference.T_degC = {20.1, std::nullopt, 1.0 / 3, std::nullopt};
  c.reference.t_utc = "2026-11-21T10:00:00.000000Z";
  c.reference.f_nT = 53907.7;
  c.data_hash = "abc";
  c.poses = 157;
  c.accepted_by_checks = true;
  c.checks = {{"volume", true, "1.0", "0.1 to 10", ""}, {"residual", false, "9", "5", "look"}};
  c.software = "mgtd";
  c.seal();
  return c;
}

TEST(CalibrationJson, ReadsBackBitForBit) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Calibration c = random_calibration(seed);
    const auto again = calibration_from_json_text(to_json_text(c));
    ASSERT_TRUE(again) << again.error().text();
    EXPECT_EQ(again->id, c.id);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(again->sensors[i].parameters(), c.sensors[i].parameters());
      EXPECT_EQ(again->sensors[i].mounting, c.sensors[i].mounting);
    }
    EXPECT_EQ(again->covariance, c.covariance);
    EXPECT_EQ(again->geometry, c.geometry);
    EXPECT_EQ(again->sample_noise_nT, c.sample_noise_nT);
    EXPECT_EQ(again->pose_noise_nT, c.pose_noise_nT);
    EXPECT_EQ(again->gauge, c.gauge);
    EXPECT_EQ(again->reference.T_degC, c.reference.T_degC);
    EXPECT_EQ(again->reference.f_nT, c.reference.f_nT);
    EXPECT_EQ(again->checks.size(), 2U);
    EXPECT_EQ(to_json_text(*again), to_json_text(c));
  }
}

TEST(CalibrationJson, TheIdIsTheHashOfTheContent) {
  const Calibration c = random_calibration(1);
  EXPECT_TRUE(std::regex_match(c.id, std::regex("c[0-9a-f]{12}")));
  Calibration same = random_calibration(1);
  EXPECT_EQ(same.id, c.id);
  same.sensors[3].scale[1] = std::nextafter(same.sensors[3].scale[1], 2.0);
  same.seal();
  EXPECT_NE(same.id, c.id);
  Calibration resealed = c;
  resealed.seal();
  EXPECT_EQ(resealed.id, c.id);
}

TEST(CalibrationJson, AnEditedFileIsRefused) {
  nlohmann::json object = to_json(random_calibration(1));
  object["sensors"][0]["cx"] = 1.0;
  const auto read = calibration_from_json(object);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::bad_input);
  EXPECT_THAT(read.error().message, HasSubstr("content was changed"));
}

TEST(CalibrationJson, AMissingKeyOrAnotherSchemaIsRefusedByName) {
  nlohmann::json object = to_json(random_calibration(1));
  nlohmann::json without = object;
  without.erase("covariance");
  EXPECT_THAT(calibration_from_json(without).error().message, HasSubstr("covariance"));
  object["schema"] = "mgt.cal/9";
  EXPECT_THAT(calibration_from_json(object).error().message, HasSubstr("mgt.cal/9"));
}

TEST(CalibrationJson, NoJsonAtAllIsRefused) {
  for (const char* text : {"", "{", "[1,2]", "pose,set\n1,standard\n", "null"}) {
    const auto read = calibration_from_json_text(text);
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().code, ErrorCode::bad_input);
  }
}

TEST(CalibrationJson, WhatIsWrongIsToldByLineAndColumnInOurWords) {
  std::string text = to_json_text(random_calibration(1));
  const std::string torn = text.substr(0, text.size() / 2);
  EXPECT_THAT(calibration_from_json_text(torn).error().message,
              HasSubstr("the text ends before the JSON does"));
  const std::size_t at = text.find("\"poses\": ") + 9;
  text.insert(at, "\"many\"; ");
  const auto lines = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  const std::string line = "line " + std::to_string(lines + 1) + ", column ";
  EXPECT_EQ(calibration_from_json_text(text).error().message, line + "17: not JSON from here on");
  text[text.find("; ", at)] = ',';
  text.insert(text.find(", ", at) + 2, "\"spare\": ");
  EXPECT_EQ(calibration_from_json_text(text).error().message,
            "not a calibration: " + line + "11: poses: a number belongs here, not a text");
}

/// Removing only part of what it says would be silent falsehood.
TEST(CalibrationJson, EffectsItCannotRemoveAreRefused) {
  nlohmann::json object = to_json(random_calibration(1));
  object["effects"].push_back({{"effect", "axis.of.evil"},
                               {"coefficients", nlohmann::json::array()},
                               {"size_nT", std::vector<double>(12)}});
  object["id"] = content_id(object);
  EXPECT_THAT(calibration_from_json(object).error().message, HasSubstr("axis.of.evil"));
}

/// What it would drop when it is written again, under an id that no longer fits.
TEST(CalibrationJson, WhatThisVersionDoesNotKnowIsRefusedByItsPath) {
  nlohmann::json object = to_json(random_calibration(1));
  object["sensors"][2]["cw"] = 1.0;
  object["id"] = content_id(object);
  EXPECT_THAT(calibration_from_json(object).error().message, HasSubstr("/sensors/2/cw"));
}

/// A file of the right shape whose values are of the wrong type is an error, never an exception.
TEST(CalibrationJson, ANumberThatWouldBeWrittenInAnotherWayIsRefused) {
  // Its id would be another one as soon as a program had read it and written it again.
  nlohmann::json object = to_json(random_calibration(3));
  object["baseline_m"] = 1;
  object["id"] = content_id(object);
  const auto read = calibration_from_json(object);
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, HasSubstr("not written as mgt writes them"));
}

TEST(CalibrationJson, EveryKeyMayBeWrong) {
  const nlohmann::json whole = to_json(random_calibration(1));
  for (const auto& [key, value] : whole.items()) {
    for (const nlohmann::json& wrong : {nlohmann::json(), nlohmann::json("word"), nlohmann::json::array()}) {
      nlohmann::json object = whole;
      if (object[key] == wrong) continue;
      object[key] = wrong;
      EXPECT_FALSE(calibration_from_json(object)) << key << ' ' << wrong.dump();
    }
  }
}

}  // namespace
}  // namespace mgtd::calib::calibration
