// SPDX-License-Identifier: Apache-2.0
#include "calib/report/measured_report.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "tests/blind/hidden_run.h"

namespace mgtd::calib::report {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

json reported(const PoseTable& table, std::optional<double> field_nT = {}) {
  fit::FitOptions options;
  options.field_nT = field_nT;
  return to_json(criticism::tests::measured_columns(table, options));
}

json panel_named(const json& said, const std::string& name) {
  for (const json& panel : said.at("panels"))
    if (panel.at("name") == name) return panel;
  return {};
}

TEST(MeasuredReport, HasTheReadingsAsTheyAre) {
  PoseTable table = testing::hidden_run({}, 4);
  table.poses[3].set = "check";
  table.poses[5].covariates["current_A"] = 2.5;
  const json said = reported(table), &poses = said.at("poses");
  ASSERT_EQ(poses.at("pose").size(), 156U) << "poses of the set check are never fitted";
  EXPECT_EQ(poses.at("pose").at(3), table.poses[4].number);
  EXPECT_EQ(poses.at("reading_nT").at("s2.y").at(0), table.poses[0].y_nT[1].y());
  EXPECT_DOUBLE_EQ(poses.at("raw_nT").at("s3").at(0), table.poses[0].y_nT[2].norm() - *table.poses[0].f_nT);
  EXPECT_EQ(poses.at("columns").at("current_A").at(4), 2.5);
  EXPECT_TRUE(poses.at("columns").at("current_A").at(0).is_null());
  EXPECT_EQ(said.at("less"), "F");
}

TEST(MeasuredReport, WithoutAFieldLengthsAreLessTheirMedian) {
  PoseTable table = testing::hidden_run({}, 4);
  for (Pose& pose : table.poses) pose.f_nT.reset();
  const json said = reported(table), given = reported(table, 50'000);
  EXPECT_EQ(said.at("less"), "its median");
  EXPECT_TRUE(panel_named(said, "measured-field").is_null());
  std::vector<double> raw = said.at("poses").at("raw_nT").at("s1");
  std::nth_element(raw.begin(), raw.begin() + 78, raw.end());
  EXPECT_EQ(raw[78], 0);
  EXPECT_EQ(given.at("less"), "F");
  EXPECT_DOUBLE_EQ(given.at("poses").at("raw_nT").at("s1").at(0), table.poses[0].y_nT[0].norm() - 50'000);
}

TEST(MeasuredReport, TellsWhereATurnAboutOneAxisHasAHole) {
  PoseTable table = testing::hidden_run({}, 4);
  EXPECT_FALSE(panel_named(reported(table), "measured-skies").at("stands_out"));
  EXPECT_FALSE(panel_named(reported(table), "measured-angles").at("stands_out"));
  table.poses.resize(36);
  const json said = reported(table);
  EXPECT_TRUE(panel_named(said, "measured-skies").at("stands_out"));
  EXPECT_TRUE(panel_named(said, "measured-angles").at("stands_out"));
  EXPECT_THAT(panel_named(said, "measured-angles").at("good").get<std::string>(),
              HasSubstr("pitch 0°, roll 0°"));
}

TEST(MeasuredReport, WhatWasNotMeasuredHasNoPanel) {
  PoseTable table = testing::hidden_run({.spreads = false}, 4);
  for (Pose& pose : table.poses) {
    pose.T_degC.fill(std::nullopt);
    pose.azimuth_rad = pose.pitch_rad = pose.roll_rad = std::nullopt;
    pose.y_nT[1].setConstant(std::nan(""));
  }
  const json said = reported(table);
  for (const char* const name :
       {"measured-temperature", "measured-angles", "measured-azimuth", "measured-spread"})
    EXPECT_TRUE(panel_named(said, name).is_null()) << name;
  EXPECT_TRUE(said.at("poses").at("reading_nT").at("s2.x").at(0).is_null());
  EXPECT_EQ(said.dump().find("nan"), std::string::npos);
}

TEST(MeasuredReport, OfNoPosesIsEmpty) { EXPECT_TRUE(reported({}).at("panels").empty()); }

}  // namespace
}  // namespace mgtd::calib::report
