// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/array_flags.h"

#include <gmock/gmock.h>

#include <fstream>

#include "calib/poses/pose_columns.h"
#include "calib/poses/pose_table.h"
#include "calib/poses/table_import.h"
#include "daemon/cli/import_map_file.h"
#include "tests/unit/daemon/temp_dir.h"

namespace mgtd::daemon::cli {
namespace {

using calib::sensor::Geometry;
using ::testing::HasSubstr;

Geometry two_places() {
  return Geometry(PerSensor<Eigen::Vector3d>{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, 0.5)});
}

ArrayFlags array_file(const test::TempDir& dir) {
  std::ofstream(dir / "two.toml") << "[array]\npositions_m = [[0, 0, 0], [0, 0, 0.5]]\n";
  return {.baseline_m = {}, .array = (dir / "two.toml").string()};
}

TEST(ArrayFlags, WithoutFlagsTheRunFileCountsThenCrossAndOrigin) {
  EXPECT_EQ(array_for({}, 4, "a.csv", std::nullopt).value(), Geometry());
  EXPECT_EQ(array_for({}, 4, "a.mgtrun", Geometry(0.7)).value(), Geometry(0.7));
  EXPECT_EQ(array_for({}, 2, "a.mgtrun", two_places()).value(), two_places());
  const Geometry one = array_for({}, 1, "a.csv", std::nullopt).value();
  ASSERT_EQ(one.sensors(), 1U);
  EXPECT_TRUE(one.positions_P_m()[0].isZero(0));
}

TEST(ArrayFlags, FlagsCountBeforeTheRunFile) {
  const test::TempDir dir;
  EXPECT_EQ(array_for({.baseline_m = 0.9, .array = {}}, 4, "a.mgtrun", Geometry(0.7)).value(), Geometry(0.9));
  const Geometry other(PerSensor<Eigen::Vector3d>{Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)});
  EXPECT_EQ(array_for(array_file(dir), 2, "a.mgtrun", other).value(), two_places());
}

TEST(ArrayFlags, PlacesThatNobodyToldAreAskedFor) {
  for (const std::size_t sensors : {2U, 3U, 5U, 8U, 16U}) {
    const auto geometry = array_for({}, sensors, "a.csv", std::nullopt);
    ASSERT_FALSE(geometry);
    EXPECT_THAT(geometry.error().message, HasSubstr("where they stand is not known"));
    EXPECT_THAT(geometry.error().remedy, HasSubstr("--array FILE.toml"));
  }
}

TEST(ArrayFlags, PlacesOfAnotherNumberOfSensorsAreRefused) {
  const test::TempDir dir;
  const auto places = array_for(array_file(dir), 8, "a.csv", std::nullopt);
  ASSERT_FALSE(places);
  EXPECT_THAT(places.error().message,
              HasSubstr("two.toml has the places of 2 sensors, and a.csv has readings of 8 sensors"));
  EXPECT_FALSE(places.error().remedy.empty());
  const auto baseline = array_for({.baseline_m = 0.4, .array = {}}, 8, "a.csv", std::nullopt);
  ASSERT_FALSE(baseline);
  EXPECT_THAT(baseline.error().message, HasSubstr("--baseline is of the cross of 4 sensors"));
  EXPECT_FALSE(
      array_for({.baseline_m = {}, .array = (dir / "none.toml").string()}, 2, "a.csv", std::nullopt));
}

/// A map makes a pose table of any array, its reference field included.
TEST(ArrayFlags, AMapNamesTheColumnsOfAnyArray) {
  const auto map = import_map_from_text(R"([columns]
s1_x_nT = {from = "ax", unit = "uT"}
s1_y_nT = {from = "ay", unit = "uT"}
s1_z_nT = {from = "az", unit = "uT", sign = -1}
s2_x_nT = "bx"
s2_y_nT = "by"
s2_z_nT = "bz"
ref_x_nT = {from = "cx", unit = "uT"}
ref_y_nT = {from = "cy", unit = "uT"}
ref_z_nT = {from = "cz", unit = "uT"}
)",
                                        "map.toml");
  ASSERT_TRUE(map) << map.error().text();
  const auto text =
      calib::poses::import_table("ax,ay,az,bx,by,bz,cx,cy,cz\n1,2,3,4,5,6,7,8,9\n", "log.csv", *map);
  ASSERT_TRUE(text) << text.error().text();
  const auto table = calib::poses::parse_pose_table(*text, "log.csv");
  ASSERT_TRUE(table) << table.error().text();
  EXPECT_EQ(calib::poses::sensors_of(*table), 2U);
  EXPECT_EQ(table->poses[0].y_nT[0], Eigen::Vector3d(1000, 2000, -3000));
  EXPECT_EQ(table->poses[0].y_nT[1], Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(*table->poses[0].ref_nT, Eigen::Vector3d(7000, 8000, 9000));
}

}  // namespace
}  // namespace mgtd::daemon::cli
