// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "calib/poses/pose_columns.h"
#include "daemon/store/database.h"
#include "daemon/store/pose_source.h"
#include "daemon/store/run_file.h"
#include "tests/unit/daemon/poses.h"
#include "tests/unit/daemon/temp_dir.h"

namespace mgtd::daemon::store {
namespace {

using test::full_pose;
using test::same;
using test::TempDir;
using ::testing::HasSubstr;

/// As full_pose, of another array.
Pose pose_of(int number, std::size_t sensors) {
  const Pose four = full_pose(number);
  Pose out = four;
  out.y_nT = no_readings(sensors);
  out.sd_nT = calib::poses::unmeasured_pose(sensors).sd_nT;
  out.T_degC = calib::poses::unmeasured_pose(sensors).T_degC;
  for (std::size_t i = 0; i < sensors; ++i) {
    out.y_nT[i] = four.y_nT[i % 4] * (1 + 0.1 * static_cast<double>(i));
    out.sd_nT[i] = four.sd_nT[i % 4];
    out.T_degC[i] = *four.T_degC[i % 4] + static_cast<double>(i);
  }
  return out;
}

/// Places that no decimal number of few digits has.
RunHeader header_of(std::size_t sensors) {
  RunHeader out;
  PerSensor<Eigen::Vector3d> places_P_m(sensors);
  for (std::size_t i = 0; i < sensors; ++i)
    places_P_m[i] = {0.1 / 3 * static_cast<double>(i), -0.7 / 9, 1e-3 * static_cast<double>(i * i)};
  out.options.geometry = calib::sensor::Geometry(places_P_m);
  out.options.sensor_names = numbered_sensors(sensors);
  out.options.sensor_names.back() = "Mag-13 #7";
  return out;
}

std::int64_t schema_of(const std::filesystem::path& path) {
  return Database::open(path, Database::Mode::read_only).value()->integer("PRAGMA user_version").value();
}

TEST(RunArray, PosesAndPlacesOfAnyArrayComeBackBitForBit) {
  for (const std::size_t sensors : {1U, 2U, 4U, 8U, 16U}) {
    TempDir dir;
    const RunHeader header = header_of(sensors);
    {
      auto file = RunFile::create(dir / "a.mgtrun", header).value();
      ASSERT_TRUE(file.append_pose(pose_of(1, sensors)));
      ASSERT_TRUE(file.append_pose(pose_of(2, sensors)));
    }
    const auto file = RunFile::open(dir / "a.mgtrun", Access::read_only).value();
    EXPECT_EQ(file.header().options.geometry, header.options.geometry);
    EXPECT_EQ(file.header().options.sensor_names, header.options.sensor_names);
    const auto poses = file.poses().value().poses;
    ASSERT_EQ(poses.size(), 2U);
    EXPECT_TRUE(same(poses[0], pose_of(1, sensors))) << sensors;
    EXPECT_TRUE(same(poses[1], pose_of(2, sensors))) << sensors;
    EXPECT_EQ(schema_of(dir / "a.mgtrun"), 2);
  }
}

/// Programs before this one read schema 1 alone, and know a cross by its baseline.
TEST(RunArray, AFileOfTheCrossIsWhatItWas) {
  TempDir dir;
  RunHeader header;
  header.options.geometry = calib::sensor::Geometry(0.7);
  ASSERT_TRUE(import_poses({{full_pose(1)}, "x"}, dir / "a.mgtrun", header));
  EXPECT_EQ(schema_of(dir / "a.mgtrun"), 1);
  const auto db = Database::open(dir / "a.mgtrun", Database::Mode::read_only).value();
  EXPECT_EQ(db->integer("SELECT count(*) FROM meta WHERE key='baseline_m' AND value='0.7'").value(), 1);
  EXPECT_EQ(db->integer("SELECT count(*) FROM meta WHERE key='positions_m'").value(), 0);
  EXPECT_EQ(db->integer("SELECT count(*) FROM sqlite_master WHERE name='reference'").value(), 0);
  EXPECT_EQ(RunFile::open(dir / "a.mgtrun", Access::read_only).value().header().options.geometry,
            calib::sensor::Geometry(0.7));
}

TEST(RunArray, TheReferenceFieldComesBackAndRaisesTheSchema) {
  TempDir dir;
  Pose with = full_pose(1), only_sd = full_pose(2), without = full_pose(3);
  with.ref_nT = Eigen::Vector3d(0.1 / 3, -1e-7, 5e4 / 3);
  with.ref_sd_nT = 0.1 / 7;
  only_sd.ref_sd_nT = 0.2;
  {
    auto file = RunFile::create(dir / "a.mgtrun", {}).value();
    ASSERT_TRUE(file.append_pose(without));
    EXPECT_EQ(schema_of(dir / "a.mgtrun"), 1);
    ASSERT_TRUE(file.append_poses(std::vector<Pose>{with, only_sd}));
    EXPECT_EQ(schema_of(dir / "a.mgtrun"), 2);
  }
  {
    auto file = RunFile::open(dir / "a.mgtrun", Access::resume).value();
    const auto poses = file.poses().value().poses;
    EXPECT_FALSE(poses[0].ref_nT || poses[0].ref_sd_nT);
    EXPECT_EQ(poses[1].ref_nT, with.ref_nT);
    EXPECT_EQ(poses[1].ref_sd_nT, with.ref_sd_nT);
    EXPECT_FALSE(poses[2].ref_nT);
    EXPECT_EQ(poses[2].ref_sd_nT, 0.2);
    ASSERT_TRUE(file.remove_poses(std::vector<int>{1}));
    with.ref_nT->x() = 9;
    ASSERT_TRUE(file.append_pose(with));
    EXPECT_EQ(file.poses().value().poses.back().ref_nT->x(), 9);
  }
}

TEST(RunArray, APoseOfAnotherArrayIsRefused) {
  TempDir dir;
  auto file = RunFile::create(dir / "a.mgtrun", header_of(2)).value();
  const auto refused = file.append_pose(full_pose(1));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("pose 1 has 4 sensors, the run file 2"));
  EXPECT_EQ(file.pose_count().value(), 0U);
}

TEST(RunArray, PlacesThatCannotBeReadAreRefused) {
  for (const char* places : {"", "[]", "{}", "[[1,2]]", "[[1,2,\"x\"]]", "[1,2,3]", "[[0,0,0]"}) {
    TempDir dir;
    { ASSERT_TRUE(RunFile::create(dir / "a.mgtrun", header_of(2))); }
    ASSERT_TRUE(Database::open(dir / "a.mgtrun", Database::Mode::read_write)
                    .value()
                    ->execute(std::string("UPDATE meta SET value='") + places + "' WHERE key='positions_m'"));
    const auto file = RunFile::open(dir / "a.mgtrun", Access::read_only);
    ASSERT_FALSE(file) << places;
    EXPECT_THAT(file.error().message, HasSubstr("the places of the sensors cannot be read")) << places;
  }
}

TEST(RunArray, RunsOfUnlikeArraysAreNotJudgedTogether) {
  TempDir dir;
  RunHeader other = header_of(2);
  other.options.geometry =
      calib::sensor::Geometry(PerSensor<Eigen::Vector3d>{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, 1)});
  ASSERT_TRUE(import_poses({{pose_of(1, 2)}, "x"}, dir / "a.mgtrun", header_of(2)));
  ASSERT_TRUE(import_poses({{pose_of(1, 2)}, "x"}, dir / "b.mgtrun", other));
  const auto both = read_runs(dir / "a.mgtrun", {(dir / "b.mgtrun").string()});
  ASSERT_FALSE(both);
  EXPECT_THAT(both.error().message, HasSubstr("another array"));
}

}  // namespace
}  // namespace mgtd::daemon::store
