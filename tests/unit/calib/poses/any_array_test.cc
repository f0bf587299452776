// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "calib/poses/joined_runs.h"
#include "calib/poses/kept_columns.h"
#include "calib/poses/pose_columns.h"
#include "calib/poses/pose_table.h"

namespace mgtd::calib::poses {
namespace {

using ::testing::HasSubstr;

/// Every reading of the array, all different.
std::string readings(std::size_t sensors) {
  std::string out;
  for (std::size_t c = 1; c <= 3 * sensors; ++c) out += fmt::format(",{}", 100 * c);
  return out;
}

std::string columns(std::initializer_list<int> sensors) {
  std::string out;
  for (const int i : sensors)
    for (const char axis : {'x', 'y', 'z'}) out += fmt::format(",s{}_{}_nT", i, axis);
  return out;
}

std::string columns(std::size_t sensors) {
  std::string out;
  for (std::size_t i = 1; i <= sensors; ++i) out += columns({static_cast<int>(i)});
  return out;
}

Error error_of(const std::string& text) {
  const auto table = parse_pose_table(text, "poses.csv");
  if (table) return {ErrorCode::internal, "it was read", ""};
  EXPECT_FALSE(table.error().remedy.empty()) << table.error().message;
  return table.error();
}

TEST(AnyArray, TheHeaderTellsHowManySensorsThereAre) {
  for (const std::size_t sensors : {1U, 2U, 3U, 4U, 8U, 16U}) {
    const std::string text = "pose,set" + columns(sensors) +
                             fmt::format(",s{0}_sd_y_nT,s{0}_T_degC", sensors) + "\n7,random" +
                             readings(sensors) + ",0.5,21\n";
    const auto table = parse_pose_table(text, "poses.csv");
    ASSERT_TRUE(table) << table.error().text();
    EXPECT_EQ(sensors_of(*table), sensors);
    const Pose& pose = table->poses[0];
    ASSERT_EQ(pose.y_nT.size(), sensors);
    ASSERT_EQ(pose.sd_nT.size(), sensors);
    ASSERT_EQ(pose.T_degC.size(), sensors);
    const double last = 300.0 * static_cast<double>(sensors);
    EXPECT_EQ(pose.y_nT.back(), Eigen::Vector3d(last - 200, last - 100, last));
    EXPECT_EQ(pose.sd_nT.back()[1], 0.5);
    EXPECT_EQ(pose.T_degC.back(), 21);
    EXPECT_EQ(format_pose_table(*table), text);
  }
}

/// Text and hash as they were when four sensors were all there could be.
TEST(AnyArray, TheTextOfFourSensorsIsWhatItWas) {
  const std::string text =
      "pose,set,t_utc,t_s,azimuth_deg,f_nT,s1_x_nT,s1_y_nT,s1_z_nT,s2_x_nT,s2_y_nT,s2_z_nT,s3_x_nT,s3_y_nT,"
      "s3_z_nT,s4_x_nT,s4_y_nT,s4_z_nT,s2_sd_z_nT,sense,s4_T_degC,battery_V\n"
      "1,standard,2026-11-21T10:00:00.000000Z,0.5,90,50000.25,1000.1,2000.1,3000.1,4000.1,5000.1,6000.1,"
      "7000.1,8000.1,9000.1,10000.1,11000.1,12000.1,0.25,-1,21.5,12.7\n"
      "2,check,,,,,-1,-2,-3,-4,-5,-6,-7,-8,-9,-10,-11,-12,,,,\n";
  const auto table = parse_pose_table(text, "poses.csv");
  ASSERT_TRUE(table) << table.error().text();
  EXPECT_EQ(format_pose_table(*table), text);
  EXPECT_EQ(data_hash(*table), "3ba51df586525a60fe6ec485f7f2981429a5741d47fcbeedd3d27b053e42bef3");
}

TEST(AnyArray, AGapInTheNumbersIsRefused) {
  const Error gap = error_of("pose" + columns({1, 2, 4}) + "\n1" + readings(3) + "\n");
  EXPECT_THAT(gap.message, HasSubstr("poses.csv:1:1: missing column: s3_x_nT, s3_y_nT, s3_z_nT"));
  EXPECT_THAT(gap.message, HasSubstr("there is an s4"));
  EXPECT_THAT(gap.remedy, HasSubstr("without a gap"));
  EXPECT_THAT(error_of("pose" + columns({2}) + "\n1" + readings(1) + "\n").message,
              HasSubstr("missing column: s1_x_nT, s1_y_nT, s1_z_nT (there is an s2)"));
}

TEST(AnyArray, EverySensorHasAllThreeAxes) {
  EXPECT_THAT(error_of("pose" + columns(1) + ",s2_x_nT,s2_z_nT\n1,1,2,3,4,5\n").message,
              HasSubstr("poses.csv:1:1: missing column: s2_y_nT"));
  EXPECT_THAT(error_of("pose,f_nT\n1,50000\n").message, HasSubstr("missing column: s1_x_nT"));
}

TEST(AnyArray, ASensorThatNoArrayHasIsRefusedWhereItStands) {
  EXPECT_THAT(error_of("pose,s17_x_nT\n1,2\n").message,
              HasSubstr("poses.csv:1:6: s17_x_nT: there is no sensor s17"));
  EXPECT_THAT(error_of("pose" + columns(1) + ",s0_y_nT\n1,1,2,3,4\n").message,
              HasSubstr("poses.csv:1:30: s0_y_nT: there is no sensor s0"));
}

TEST(AnyArray, NoiseAndTemperatureAreOfSensorsThatWereRead) {
  for (const char* column : {"s3_T_degC", "s3_sd_x_nT"}) {
    const Error error = error_of("pose" + columns(2) + "," + column + "\n1" + readings(2) + ",20\n");
    EXPECT_THAT(error.message,
                HasSubstr(fmt::format("poses.csv:1:54: {}: there are no readings of s3", column)));
  }
}

TEST(AnyArray, ANameThatOnlyLooksLikeASensorIsACovariate) {
  const auto table =
      parse_pose_table("pose" + columns(1) + ",s2_current_A,s02_x_nT,s_x_nT\n1,1,2,3,4,5,6\n", "poses.csv");
  ASSERT_TRUE(table) << table.error().text();
  EXPECT_EQ(sensors_of(*table), 1U);
  EXPECT_EQ(table->poses[0].covariates.size(), 3U);
}

TEST(AnyArray, TheReferenceFieldSurvives) {
  const std::string text = "pose,set,f_nT,ref_x_nT,ref_y_nT,ref_z_nT,ref_sd_nT" + columns(1) +
                           "\n1,random,0,0.5,-0.25,1e-05,0.1" + readings(1) + "\n2,random,,,,," +
                           readings(1) + "\n";
  const auto table = parse_pose_table(text, "poses.csv");
  ASSERT_TRUE(table) << table.error().text();
  EXPECT_EQ(*table->poses[0].ref_nT, Eigen::Vector3d(0.5, -0.25, 1e-5));
  EXPECT_EQ(table->poses[0].ref_sd_nT, 0.1);
  EXPECT_EQ(table->poses[0].f_nT, 0);
  EXPECT_FALSE(table->poses[1].ref_nT);
  EXPECT_FALSE(table->poses[1].ref_sd_nT);
  EXPECT_EQ(format_pose_table(*table), text);
}

TEST(AnyArray, PartOfAReferenceFieldIsRefused) {
  EXPECT_THAT(error_of("pose,ref_x_nT,ref_z_nT" + columns(1) + "\n1,1,2" + readings(1) + "\n").message,
              HasSubstr("poses.csv:1:1: missing column: ref_y_nT"));
  EXPECT_THAT(error_of("pose,ref_sd_nT" + columns(1) + "\n1,1" + readings(1) + "\n").message,
              HasSubstr("missing column: ref_x_nT, ref_y_nT, ref_z_nT"));
  EXPECT_THAT(
      error_of("pose,ref_x_nT,ref_y_nT,ref_z_nT" + columns(1) + "\n1,10,,30" + readings(1) + "\n").message,
      HasSubstr("poses.csv:2:6: ref_y_nT is empty"));
  EXPECT_THAT(
      error_of("pose,ref_x_nT,ref_y_nT,ref_z_nT,ref_sd_nT" + columns(1) + "\n1,1,2,3,0" + readings(1) + "\n")
          .message,
      HasSubstr("poses.csv:2:9: 0 in column ref_sd_nT is not possible: it must be above 0"));
}

TEST(AnyArray, AColumnInAnotherUnitIsNamedAsSuch) {
  const auto remedy = [](const std::string& f) {
    return error_of("pose,f_nT" + columns(1) + "\n1," + f + readings(1) + "\n").remedy;
  };
  EXPECT_THAT(remedy("53.9"),
              HasSubstr("the column looks like uT: multiply all of it by 1000; if it is this row "
                        "alone, leave the cell empty"));
  EXPECT_THAT(remedy("0.539"), HasSubstr("looks like G: multiply all of it by 100000;"));
  EXPECT_THAT(remedy("5.39e-5"), HasSubstr("looks like T: multiply all of it by 1000000000;"));
  EXPECT_THAT(remedy("250000"), HasSubstr("check unit and column"));
  EXPECT_THAT(
      error_of("pose" + columns(1) + "\n1,22551407,1,1\n").remedy,
      HasSubstr("looks like pT: multiply all of it by 0.001; if it is this row alone, leave the whole pose"));
}

/// Without a vector beside it, a total field of nearly zero is a slip of the unit.
TEST(AnyArray, ASmallFieldNeedsAReferenceField) {
  EXPECT_THAT(
      error_of("pose,f_nT" + columns(1) + "\n1,50.1" + readings(1) + "\n").message,
      HasSubstr("poses.csv:2:3: 50.1 in column f_nT is not possible: it must be from 1000 to 200000"));
  EXPECT_THAT(
      error_of("pose,f_nT,ref_x_nT,ref_y_nT,ref_z_nT" + columns(1) + "\n1,-1,1,2,3" + readings(1) + "\n")
          .message,
      HasSubstr("it must be from 0 to 200000"));
}

TEST(AnyArray, WhereTheArrayStoodIsKeptAndNeverFitted) {
  const std::string text =
      "pose,set" + columns(1) + ",h_ellipsoid_m,lat_deg,lon_deg\n1,random" + readings(1) + ",212.5,47.5,19\n";
  const auto table = parse_pose_table(text, "poses.csv");
  ASSERT_TRUE(table) << table.error().text();
  EXPECT_EQ(table->poses[0].covariates.at("lat_deg"), 47.5);
  EXPECT_EQ(format_pose_table(*table), text);
  for (const auto& [name, value] : table->poses[0].covariates) EXPECT_TRUE(never_fitted(name)) << name;
  EXPECT_FALSE(never_fitted("battery_V"));
}

TEST(AnyArray, AListIsOfTheArrayThatIsPlannedFor) {
  const std::string text = "pose,azimuth_deg,pitch_deg,roll_deg,s2_T_degC\n1,0,0,0,20\n";
  const auto two = parse_pose_list(text, "list.csv", 2);
  ASSERT_TRUE(two) << two.error().text();
  EXPECT_EQ(two->poses[0].T_degC.size(), 2U);
  const auto one = parse_pose_list(text, "list.csv", 1);
  ASSERT_FALSE(one);
  EXPECT_THAT(one.error().message, HasSubstr("list.csv:1:37: s2_T_degC: the array has 1 sensor"));
}

TEST(AnyArray, RunsOfUnlikeArraysAreNotJoined) {
  const auto a = parse_pose_table("pose" + columns(1) + "\n1" + readings(1) + "\n", "one.csv");
  const auto b = parse_pose_table("pose" + columns(2) + "\n1" + readings(2) + "\n", "two.csv");
  ASSERT_TRUE(a && b);
  const auto both = joined(*a, *b);
  ASSERT_FALSE(both);
  EXPECT_THAT(both.error().message, HasSubstr("one.csv has 1 sensor and two.csv has 2 sensors"));
}

/// References to the columns are kept by those who read many tables.
TEST(AnyArray, TheColumnsOfANumberAreMadeOnce) {
  EXPECT_EQ(&pose_columns(3), &pose_columns(3));
  EXPECT_EQ(pose_columns(5).size() - pose_columns(4).size(), 7U);
}

}  // namespace
}  // namespace mgtd::calib::poses
