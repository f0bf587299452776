// SPDX-License-Identifier: Apache-2.0
#include "calib/poses/pose_table.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <bit>
#include <nlohmann/json.hpp>
#include <random>

#include "proto/units.h"
#include "tests/support/paper_rigs.h"

namespace mgtd::calib::poses {
namespace {

using ::testing::HasSubstr;

std::string header(const std::string& first = "pose,set") {
  std::string out = first;
  for (int i = 1; i <= 4; ++i) {
    for (const char axis : {'x', 'y', 'z'}) out += fmt::format(",s{}_{}_nT", i, axis);
  }
  return out;
}

constexpr const char* kReadings = "1,2,3,4,5,6,7,8,9,10,11,12";

std::string small(const std::string& extra_header = "", const std::string& extra_cells = "") {
  return header() + extra_header + "\n1,standard," + kReadings + extra_cells + "\n";
}

Error error_of(const std::string& text) {
  const auto table = parse_pose_table(text, "poses.csv");
  if (table) return {ErrorCode::internal, "it was read", ""};
  EXPECT_EQ(table.error().code, ErrorCode::bad_input);
  EXPECT_FALSE(table.error().remedy.empty()) << table.error().message;
  return table.error();
}

/// Spreadsheets and data frames write so.
TEST(PoseTable, ReadsCellsInQuotes) {
  std::string quoted;
  for (const char c : small())
    quoted += c == ',' ? std::string("\",\"") : c == '\n' ? "\"\n\"" : std::string(1, c);
  quoted = "\"" + quoted.substr(0, quoted.size() - 1);
  const auto plain = parse_pose_table(small(), "poses.csv"), table = parse_pose_table(quoted, "poses.csv");
  ASSERT_TRUE(table) << table.error().text();
  EXPECT_EQ(data_hash(*table), data_hash(*plain));
  const auto named = parse_pose_table(small(",\"I, \"\"motor\"\"\"", ",4"), "poses.csv");
  ASSERT_TRUE(named) << named.error().text();
  EXPECT_EQ(named->poses.front().covariates.at("I, \"motor\""), 4);
  const auto inch = parse_pose_table(small(",5\" cross", ",4"), "poses.csv");
  ASSERT_TRUE(inch) << inch.error().text();
  EXPECT_EQ(inch->poses.front().covariates.at("5\" cross"), 4);
  const auto again = parse_pose_table(format_pose_table(*named), "poses.csv");
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(again->poses.front().covariates, named->poses.front().covariates);
}

TEST(PoseTable, LinesMayEndInAnyWay) {
  for (const char* end : {"\r", "\r\n"}) {
    std::string text;
    for (const char c : small()) text += c == '\n' ? std::string(end) : std::string(1, c);
    const auto table = parse_pose_table(text + "x", "poses.csv");
    ASSERT_FALSE(table);
    EXPECT_THAT(table.error().message, HasSubstr("poses.csv:3:1: 1 cells"));
    EXPECT_TRUE(parse_pose_table(text, "poses.csv"));
  }
}

/// How many sensors there are is not known where no reading is named.
TEST(PoseTable, ATableOfOtherColumnsIsToldOfTheImport) {
  const Error other = error_of("pose,x,y,z\n1,2,3,4\n");
  EXPECT_THAT(other.message,
              HasSubstr("missing column: s1_x_nT, s1_y_nT, s1_z_nT, and those of further sensors"));
  EXPECT_THAT(other.remedy, HasSubstr("mgt import --columns MAP.toml"));
  EXPECT_THAT(error_of("pose;x\n1;2\n").remedy, HasSubstr("mgt import --columns MAP.toml"));
}

TEST(PoseTable, ReadsReadingsAnglesAndTimes) {
  const auto table = parse_pose_table(small(",azimuth_deg,t_s,t_utc,f_nT,sense,s2_T_degC,battery_V",
                                            ",90,12.5,2026-11-21T10:00:00Z,50000.25,-1,21.5,12.7"),
                                      "poses.csv");
  ASSERT_TRUE(table) << table.error().text();
  const Pose& pose = table->poses.at(0);
  EXPECT_EQ(pose.number, 1);
  EXPECT_EQ(pose.set, "standard");
  EXPECT_EQ(pose.y_nT[3], Eigen::Vector3d(10, 11, 12));
  EXPECT_NEAR(*pose.azimuth_rad, to_rad(90.0), 1e-15);
  EXPECT_FALSE(pose.pitch_rad);
  EXPECT_EQ(pose.t_s, 12.5);
  EXPECT_EQ(format_utc(*pose.t_utc), "2026-11-21T10:00:00.000000Z");
  EXPECT_EQ(pose.f_nT, 50000.25);
  EXPECT_EQ(pose.sense, -1);
  EXPECT_EQ(pose.T_degC[1], 21.5);
  EXPECT_FALSE(pose.T_degC[0]);
  EXPECT_EQ(pose.covariates.at("battery_V"), 12.7);
}

TEST(PoseTable, ToleratesWhatSpreadsheetsAndEditorsDo) {
  std::string text = "\xef\xbb\xbf# made by hand\n\n" + small() + "\n# end\n";
  std::string crlf;
  for (const char c : text) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const auto table = parse_pose_table(crlf, "poses.csv");
  ASSERT_TRUE(table) << table.error().text();
  EXPECT_EQ(table->poses.size(), 1U);
  EXPECT_EQ(table->poses[0].y_nT[0], Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(parse_pose_table(header() + "\n 1 , standard , 1, 2,3,4,5,6,7,8,9,10,11, 12 ", "x"));
}

TEST(PoseTable, AnEmptyCellIsNotMeasured) {
  const auto table = parse_pose_table(small(",f_nT,azimuth_deg", ",,"), "poses.csv");
  ASSERT_TRUE(table);
  EXPECT_FALSE(table->poses[0].f_nT);
  EXPECT_FALSE(table->poses[0].azimuth_rad);
}

TEST(PoseTable, AMissingColumnIsNamed) {
  std::string text = small();
  text.replace(text.find("s3_y_nT"), 7, "s3_y_uT");
  EXPECT_THAT(error_of(text).message, HasSubstr("poses.csv:1:1: missing column: s3_y_nT"));
}

TEST(PoseTable, ATableWithoutAHeaderIsToldSo) {
  const Error error = parse_pose_table("0.0,20000,-1000,45000\n0.0,20001,-1002,45003\n", "p.csv").error();
  EXPECT_THAT(error.message, HasSubstr("p.csv:1:1: numbers stand where the names"));
  EXPECT_THAT(error.remedy, HasSubstr("header row"));
}

TEST(PoseTable, AColumnNamedTwiceIsRefused) {
  EXPECT_THAT(error_of(small(",f_nT,f_nT", ",1,2")).message, HasSubstr("'f_nT' stands here twice"));
}

TEST(PoseTable, TextWhereANumberBelongsIsFoundByLineAndColumn) {
  const std::string text = "# note\n" + header() + "\n1,standard,1,2,three,4,5,6,7,8,9,10,11,12\n";
  EXPECT_THAT(error_of(text).message, HasSubstr("poses.csv:3:16: 'three' in column s1_z_nT"));
}

TEST(PoseTable, WhatIsNoFiniteNumberIsRefused) {
  for (const char* bad : {"nan", "NaN", "inf", "-inf", "1e999", "1,5", "0x10", "--1", "1 2"}) {
    const std::string message =
        error_of(header() + "\n1,standard," + bad + ",2,3,4,5,6,7,8,9,10,11,12\n").message;
    EXPECT_THAT(message, HasSubstr("poses.csv:2:")) << bad;
  }
  EXPECT_THAT(error_of(small(",f_nT", ",nan")).message, HasSubstr("'nan' in column f_nT"));
}

TEST(PoseTable, AReadingMustBeThere) {
  EXPECT_THAT(error_of(header() + "\n1,standard,1,2,3,4,5,6,7,8,,10,11,12\n").message,
              HasSubstr("poses.csv:2:28: s3_z_nT is empty"));
}

TEST(PoseTable, APoseNumberTwiceIsRefusedWithBothLines) {
  const std::string message = error_of(small() + "\n1,random," + kReadings + "\n").message;
  EXPECT_THAT(message, HasSubstr("poses.csv:4:1: pose 1 was already given in line 2"));
}

TEST(PoseTable, ARowOfAnotherLengthIsRefused) {
  EXPECT_THAT(error_of(header() + "\n1,standard,1,2,3\n").message,
              HasSubstr("poses.csv:2:1: 5 cells, but the header names 14 columns"));
}

TEST(PoseTable, AnUnreadableTimeOrNumberOfAPoseIsRefused) {
  EXPECT_THAT(error_of(small(",t_utc", ",yesterday")).message, HasSubstr("poses.csv:2:"));
  EXPECT_THAT(error_of(header() + "\n1.5,standard," + kReadings + "\n").message,
              HasSubstr("'1.5' is not a whole"));
  EXPECT_THAT(error_of(header() + "\n,standard," + kReadings + "\n").message, HasSubstr("is not a whole"));
}

TEST(PoseTable, WholeNumbersStayWhole) {
  EXPECT_THAT(error_of(small(",sense", ",0.5")).message, HasSubstr("sense"));
  EXPECT_THAT(error_of(small(",mount", ",1e30")).message, HasSubstr("mount"));
}

/// What cannot be is refused where it stands; the ends of the range are not.
TEST(PoseTable, ImpossibleValuesAreRefused) {
  struct Case {
    const char *column, *value, *limit;
  };
  for (const Case& c : std::initializer_list<Case>{{"f_sd_nT", "0", "above 0"},
                                                   {"f_sd_nT", "-0.05", "above 0"},
                                                   {"s2_sd_y_nT", "-1", "at least 0"},
                                                   {"n", "0", "at least 1"},
                                                   {"n_eff", "0", "above 0"},
                                                   {"sense", "0", "-1 or +1"},
                                                   {"sense", "2", "-1 or +1"},
                                                   {"dwell_s", "0", "above 0"},
                                                   {"s1_T_degC", "-273", "from -100 to 150"},
                                                   {"s4_T_degC", "150.1", "from -100 to 150"},
                                                   {"f_nT", "50.012", "from 1000 to 200000"},
                                                   {"f_nT", "200001", "from 1000 to 200000"}}) {
    const Error error = error_of(small("," + std::string(c.column), "," + std::string(c.value)));
    EXPECT_THAT(error.message,
                HasSubstr("poses.csv:2:39: " + std::string(c.value) + " in column " + c.column));
    EXPECT_THAT(error.message, HasSubstr(c.limit));
  }
  std::string reading = small();
  reading.replace(reading.find(",1,2,3"), 2, ",1.1e7");
  EXPECT_THAT(error_of(reading).message, HasSubstr("poses.csv:2:12: 1.1e7 in column s1_x_nT"));
}

TEST(PoseTable, WhatAnInstrumentCanGiveIsNotRefused) {
  const auto table = parse_pose_table(
      small(",f_nT,f_sd_nT,s1_sd_x_nT,n,n_eff,sense,dwell_s,s1_T_degC", ",200000,1e-3,0,1,0.5,1,0.1,-100"),
      "x");
  ASSERT_TRUE(table) << table.error().text();
  EXPECT_EQ(table->poses[0].sense, 1);
}

TEST(PoseTable, AnEmptyFileAndAHeaderAloneAreRefused) {
  EXPECT_THAT(error_of("").message, HasSubstr("empty"));
  EXPECT_THAT(error_of("# only words\n\n").message, HasSubstr("empty"));
  EXPECT_THAT(error_of(header() + "\n").message, HasSubstr("no pose"));
}

/// Any double that a column takes survives: written, read, written again it is the same text.
TEST(PoseTable, WritingAndReadingGivesTheSameBits) {
  std::mt19937_64 random(20261121);
  const auto any_double = [&] {
    while (true) {
      const double value = std::bit_cast<double>(random());
      if (std::isfinite(value)) return value;
    }
  };
  const auto any_between = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  for (int trial = 0; trial < 300; ++trial) {
    PoseTable table;
    for (int k = 0; k < 3; ++k) {
      Pose pose;
      pose.number = 10 * trial + k;
      pose.set = k == 0 ? "standard" : "random";
      for (auto& y : pose.y_nT)
        y = Eigen::Vector3d{any_between(-1e7, 1e7), any_between(-1, 1), any_between(-1e5, 1e5)};
      if (random() % 2 != 0) pose.t_s = any_double();
      if (random() % 2 != 0) pose.f_nT = any_between(1e3, 2e5);
      if (random() % 2 != 0) pose.sd_nT[2][1] = std::abs(any_double());
      if (random() % 2 != 0) pose.T_degC[3] = any_between(-100, 150);
      if (random() % 2 != 0) pose.sense = random() % 2 != 0 ? 1 : -1;
      if (random() % 2 != 0)
        pose.t_utc = WallTime{static_cast<std::int64_t>(random() % 4'000'000'000'000) * 1000};
      if (random() % 2 != 0) pose.covariates["motor_A"] = any_double();
      table.poses.push_back(pose);
    }
    const std::string text = format_pose_table(table);
    const auto again = parse_pose_table(text, "memory");
    ASSERT_TRUE(again) << again.error().text();
    for (std::size_t k = 0; k < table.poses.size(); ++k) {
      const Pose &a = table.poses[k], &b = again->poses[k];
      EXPECT_EQ(a.y_nT, b.y_nT);
      EXPECT_EQ(a.t_s, b.t_s);
      EXPECT_EQ(a.f_nT, b.f_nT);
      EXPECT_EQ(a.sd_nT, b.sd_nT);
      EXPECT_EQ(a.T_degC, b.T_degC);
      EXPECT_EQ(a.sense, b.sense);
      EXPECT_EQ(a.t_utc, b.t_utc);
      EXPECT_EQ(a.covariates, b.covariates);
    }
    EXPECT_EQ(format_pose_table(*again), text);
    EXPECT_EQ(data_hash(*again), data_hash(table));
  }
}

TEST(PoseTable, AnglesSurviveToAMillionthOfADegreeAndTheTextIsStable) {
  const PoseTable table = mgtd::testing::measure(mgtd::testing::table6_rig(), {50'000, 60, -5},
                                                 mgtd::testing::standard_run(121, 3), 36, {}, 1);
  const auto again = parse_pose_table(format_pose_table(table), "memory");
  ASSERT_TRUE(again);
  for (std::size_t k = 0; k < table.poses.size(); ++k)
    EXPECT_NEAR(*again->poses[k].roll_rad, *table.poses[k].roll_rad, to_rad(1e-9));
  EXPECT_EQ(format_pose_table(*again), format_pose_table(table));
}

TEST(PoseTable, AnotherKindOfFileIsCalledByItsName) {
  EXPECT_THAT(error_of("pose;set;f_nT\n1;random;50000\n").message, HasSubstr("separated by semicolons"));
  EXPECT_THAT(error_of("pose\tset\tf_nT\n").message, HasSubstr("separated by tabs"));
  EXPECT_THAT(error_of("{\"schema\": \"mgt.cal/1\"}\n").message, HasSubstr("JSON, not a table"));
  EXPECT_THAT(error_of("\xFF\xFEp").message, HasSubstr("UTF-16"));
  EXPECT_THAT(error_of(std::string("pose,\0set\n", 10)).message, HasSubstr("zero bytes"));
}

TEST(PoseList, NeedsAnglesAndNoReadings) {
  const auto list =
      parse_pose_list("pose,azimuth_deg,pitch_deg,roll_deg,s1_T_degC\n7,90,-45,180,21.5\n", "list.csv");
  ASSERT_TRUE(list) << list.error().text();
  EXPECT_EQ(list->poses.front().number, 7);
  EXPECT_NEAR(*list->poses.front().pitch_rad, to_rad(-45), 1e-15);
  EXPECT_EQ(list->poses.front().T_degC[0], 21.5);
  const auto missing = parse_pose_list("pose,azimuth_deg,pitch_deg\n1,0,0\n", "list.csv");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("list.csv:1:1: missing column: roll_deg"), std::string::npos);
  const auto empty = parse_pose_list("pose,azimuth_deg,pitch_deg,roll_deg\n1,0,,0\n", "list.csv");
  ASSERT_FALSE(empty);
  EXPECT_NE(empty.error().message.find("list.csv:2:5: pitch_deg is empty"), std::string::npos);
}

TEST(PoseTable, TheHashIsOfTheContent) {
  PoseTable table = mgtd::testing::measure(mgtd::testing::table6_rig(), {50'000, 60, -5},
                                           mgtd::testing::standard_run(2, 3), 36, {}, 1);
  const std::string before = data_hash(table);
  table.source = "elsewhere.csv";
  EXPECT_EQ(data_hash(table), before);
  table.poses[5].y_nT[1][2] = std::nextafter(table.poses[5].y_nT[1][2], 1e9);
  EXPECT_NE(data_hash(table), before);
}

}  // namespace
}  // namespace mgtd::calib::poses
