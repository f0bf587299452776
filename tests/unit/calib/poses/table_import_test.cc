// SPDX-License-Identifier: Apache-2.0
#include "calib/poses/table_import.h"

#include <gmock/gmock.h>

#include "calib/poses/pose_table.h"

namespace mgtd::calib::poses {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

ImportMap three_axes(std::string x, std::string y, std::string z, double scale = 1) {
  return {.columns = {{"s1_x_nT", std::move(x), scale},
                      {"s1_y_nT", std::move(y), scale},
                      {"s1_z_nT", std::move(z), scale}}};
}

TEST(TableImport, ColumnsAreChosenOrderedAndScaled) {
  ImportMap map = three_axes("mz", "mx", "my", 1000);
  map.columns[0].scale = -1000;
  const auto text = import_table("t,mx,my,mz,v\n0,1,2,3,9\n1,4,5,6,9\n", "log.csv", map);
  ASSERT_TRUE(text) << text.error().text();
  EXPECT_EQ(*text, "pose,s1_x_nT,s1_y_nT,s1_z_nT\n1,-3000,1000,2000\n2,-6000,4000,5000\n");
}

TEST(TableImport, DelimiterIsFoundInTheFirstLine) {
  for (const char* text : {"a;b;c\n1;2;3\n", "a\tb\tc\n1\t2\t3\n", "a b   c\n 1  2 3 \n", "a|b|c\n1|2|3\n"}) {
    const auto out = import_table(text, "f", three_axes("a", "b", "c"));
    ASSERT_TRUE(out) << text << out.error().text();
    EXPECT_EQ(*out, "pose,s1_x_nT,s1_y_nT,s1_z_nT\n1,1,2,3\n") << text;
  }
}

TEST(TableImport, WithoutAHeaderColumnsAreNumbered) {
  ImportMap map = three_axes("3", "1", "2");
  map.header = false;
  const auto out = import_table("1, 2, 3\n4, 5, 6\n", "f", map);
  ASSERT_TRUE(out) << out.error().text();
  EXPECT_EQ(*out, "pose,s1_x_nT,s1_y_nT,s1_z_nT\n1,3,1,2\n2,6,4,5\n");
}

TEST(TableImport, QuotesDecimalCommaAndComments) {
  ImportMap map = three_axes("field, x", "y", "z");
  map.decimal = ',';
  const auto out = import_table("# of May\n\"field, x\";y;z\n\"1,5\";-2,5;+3\n# end\n", "f", map);
  ASSERT_TRUE(out) << out.error().text();
  EXPECT_EQ(*out, "\npose,s1_x_nT,s1_y_nT,s1_z_nT\n1,1.5,-2.5,3\n\n");
}

TEST(TableImport, EveryRowStandsInItsOwnLine) {
  ImportMap map = three_axes("a", "b", "c");
  map.every = 2;
  map.skip = 1;
  const auto out = import_table("made by X\na,b,c\n1,2,3\n4,5,6\n7,8,9\n", "f", map);
  ASSERT_TRUE(out) << out.error().text();
  EXPECT_EQ(*out, "\npose,s1_x_nT,s1_y_nT,s1_z_nT\n1,1,2,3\n\n2,7,8,9\n");
}

TEST(TableImport, TimesCountFromTheFirstRow) {
  ImportMap map = three_axes("a", "b", "c");
  map.time = ImportedTime{.from = "t", .unit_s = 1e-3};
  const auto out = import_table("t,a,b,c\n5000,1,2,3\n5250,4,5,6\n", "f", map);
  ASSERT_TRUE(out) << out.error().text();
  EXPECT_EQ(*out, "pose,t_s,s1_x_nT,s1_y_nT,s1_z_nT\n1,0,1,2,3\n2,0.25,4,5,6\n");
  map.time = ImportedTime{.from = {}, .rate_hz = 50};
  const auto even = import_table("t,a,b,c\n5000,1,2,3\n5250,4,5,6\n", "f", map);
  ASSERT_TRUE(even) << even.error().text();
  EXPECT_THAT(*even, HasSubstr("\n2,0.02,4,5,6\n"));
  map.time = ImportedTime{.from = "t", .utc = true};
  const auto dates = import_table("t,a,b,c\n2026-11-21T10:00:00Z,1,2,3\n", "f", map);
  ASSERT_TRUE(dates) << dates.error().text();
  EXPECT_EQ(*dates, "pose,t_utc,s1_x_nT,s1_y_nT,s1_z_nT\n1,2026-11-21T10:00:00.000000Z,1,2,3\n");
}

TEST(TableImport, AnEmptyCellStaysEmpty) {
  ImportMap map = three_axes("a", "b", "c");
  map.columns.push_back({"s1_T_degC", "T", 1, -273.15});
  const auto out = import_table("a,b,c,T\n1,2,3,\n4,5,6,300\n", "f", map);
  ASSERT_TRUE(out) << out.error().text();
  EXPECT_THAT(*out, HasSubstr("\n1,1,2,3,\n2,4,5,6,26.85"));
}

TEST(TableImport, LinesMayEndAsOnAnOldMacintosh) {
  const auto out = import_table("a,b,c\r1,2,3\r4,5,6", "f", three_axes("a", "b", "c"));
  ASSERT_TRUE(out) << out.error().text();
  EXPECT_EQ(*out, "pose,s1_x_nT,s1_y_nT,s1_z_nT\n1,1,2,3\n2,4,5,6\n");
}

/// Which of the two is meant nobody can tell; one that the map does not ask for may be there twice.
TEST(TableImport, AColumnThatIsThereTwiceIsRefused) {
  const auto out = import_table("# log\na,b,c,b\n1,2,3,4\n", "f", three_axes("a", "b", "c"));
  ASSERT_FALSE(out);
  EXPECT_THAT(out.error().message, HasSubstr("f:2:7: column 'b' stands here twice"));
  EXPECT_TRUE(import_table("a,b,c,d,d\n1,2,3,4,5\n", "f", three_axes("a", "b", "c")));
  ImportMap timed = three_axes("a", "b", "c");
  timed.time = ImportedTime{.from = "t"};
  EXPECT_FALSE(import_table("t,a,b,c,t\n0,1,2,3,1\n", "f", timed));
}

TEST(TableImport, TheRemedyIsOfTheFile) {
  const std::string wide(
      "\xFF\xFE"
      "a\0,\0b\0\n\0",
      10);
  const auto utf16 = import_table(wide, "f", three_axes("a", "b", "c"));
  ASSERT_FALSE(utf16);
  EXPECT_THAT(utf16.error().text(), HasSubstr("f: the file is UTF-16 text; save it as text in UTF-8"));
  const auto nan = import_table("a,b,c\n1,nan,3\n", "f", three_axes("a", "b", "c"));
  ASSERT_FALSE(nan);
  EXPECT_THAT(nan.error().remedy, HasSubstr("where nothing was measured the cell is empty"));
}

struct Refusal {
  const char* text;
  const char* where;
  const char* what;
};

TEST(TableImport, RefusalsNameThePlaceInTheFile) {
  for (const Refusal& r : {Refusal{"a,b\n1,2\n", "f:1:1:", "there is no column 'c'"},
                           Refusal{"a,b,c\n1,2\n", "f:2:1:", "2 cells where 3 are expected"},
                           Refusal{"a,b,c\n1,2,3\n1,x,3\n", "f:3:3:", "'x' in column b is not a number"},
                           Refusal{"a,b,c\n1,nan,3\n", "f:2:3:", "'nan' in column b is not a number"},
                           Refusal{"a,b,c\n", "f:", "no row"}, Refusal{"", "f:", "no row"}}) {
    const auto out = import_table(r.text, "f", three_axes("a", "b", "c"));
    ASSERT_FALSE(out) << r.text;
    EXPECT_THAT(out.error().message, HasSubstr(r.where));
    EXPECT_THAT(out.error().message, HasSubstr(r.what));
  }
}

TEST(TableImport, ATimeThatGoesBackIsRefused) {
  ImportMap map = three_axes("a", "b", "c");
  map.time = ImportedTime{.from = "t"};
  const auto out = import_table("t,a,b,c\n2,1,2,3\n1,4,5,6\n", "f", map);
  ASSERT_FALSE(out);
  EXPECT_THAT(out.error().message, HasSubstr("f:3:1: the time goes back"));
  map.time->utc = true;
  const auto dates =
      import_table("t,a,b,c\n2026-11-21T10:00:01Z,1,2,3\n2026-11-21T10:00:00Z,4,5,6\n", "f", map);
  ASSERT_FALSE(dates);
  EXPECT_THAT(dates.error().message, HasSubstr("f:3:1: the time goes back"));
}

/// Who writes the map sends nobody to write one, and has no header row to add to.
TEST(TableImport, AColumnThatTheMapDoesNotNameIsMissingThere) {
  const auto refused = [](ImportMap map) {
    const auto text = import_table("a,b,c\n1,2,3\n", "log.csv", map);
    EXPECT_TRUE(text) << text.error().text();
    const auto table = parse_pose_table(text.value_or(""), "log.csv", "map.toml");
    return table ? Error{} : table.error();
  };
  ImportMap map = three_axes("a", "b", "c");
  map.columns.pop_back();
  const Error missing = refused(map);
  EXPECT_EQ(missing.message, "map.toml: missing column: s1_z_nT");
  EXPECT_THAT(missing.remedy, HasSubstr("[columns] of the map"));
  for (ImportedColumn& column : map.columns) column.to = column.to.substr(0, 5) + "uT";
  const Error microtesla = refused(map);
  EXPECT_THAT(microtesla.remedy, HasSubstr("unit = \"uT\""));
  for (const Error& error : {missing, microtesla}) EXPECT_THAT(error.remedy, Not(HasSubstr("mgt import")));
}

TEST(UnitStep, KnowsTheUnitsOfAColumnByItsName) {
  EXPECT_EQ(unit_step("s1_x_nT", "uT")->scale, 1000);
  EXPECT_EQ(unit_step("s1_x_nT", "G")->scale, 1e5);
  EXPECT_NEAR(unit_step("azimuth_deg", "rad")->scale, 57.29577951308232, 1e-12);
  EXPECT_EQ(unit_step("s1_T_degC", "K")->offset, -273.15);
  const auto wrong = unit_step("s1_x_nT", "V");
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().remedy, HasSubstr("nT, pT, uT"));
  EXPECT_FALSE(unit_step("speed", "m"));
}

}  // namespace
}  // namespace mgtd::calib::poses
