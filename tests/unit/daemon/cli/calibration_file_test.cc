// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/calibration_file.h"

#include <gmock/gmock.h>

#include <fstream>

#include "calib/calibration/calibration_json.h"
#include "calib/poses/pose_table.h"
#include "tests/unit/calib/fit/fitted_arrays.h"
#include "tests/unit/daemon/temp_dir.h"

namespace mgtd::daemon::cli {
namespace {

using calib::testing::geometry_of;
using calib::testing::two_along_x;
using ::testing::HasSubstr;

/// A run of two sensors as a pose table, which does not know where they stand, and its calibration.
struct Pair {
  Pair() {
    std::ofstream(csv, std::ios::binary) << calib::poses::format_pose_table(table);
    std::ofstream(json) << calib::calibration::to_json_text(calibration);
  }
  test::TempDir dir;
  std::string csv{(dir / "two.csv").string()}, json{(dir / "two.json").string()};
  PoseTable table{calib::testing::turned_run(two_along_x(), 1)};
  calib::calibration::Calibration calibration{calib::testing::fitted(table, two_along_x()).calibration};
};

TEST(CalibrationFile, APoseTableTakesThePlacesOfTheOtherFile) {
  const Pair pair;
  for (const std::vector<std::string>& files : {std::vector{pair.csv, pair.json}, {pair.json, pair.csv}}) {
    const auto flags = with_places_of(files, {});
    ASSERT_TRUE(flags) << flags.error().text();
    const auto fitted = calibration_of(pair.csv, *flags);
    ASSERT_TRUE(fitted) << fitted.error().text();
    EXPECT_TRUE(fitted->geometry.agrees_with(geometry_of(two_along_x())));
  }
  EXPECT_THAT(calibration_of(pair.csv, {}).error().message, HasSubstr("where they stand is not known"));
}

TEST(CalibrationFile, ARunOfOtherPlacesIsRefused) {
  const Pair pair;
  store::PoseSource source{.table = pair.table, .header = store::RunHeader{}};
  source.table.source = "b.mgtrun";
  source.header->options.geometry = pair.calibration.geometry;
  EXPECT_TRUE(same_array(pair.calibration, "a.json", source));
  source.header->options.geometry = geometry_of({{0.25, 0, 0}, {-0.3, 0, 0}});
  const auto refused = same_array(pair.calibration, "a.json", source);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message,
            "a.json is of an array of 2 sensors with s2 at (-0.25, 0, 0) m, and b.mgtrun of an array of 2 "
            "sensors with s2 at (-0.3, 0, 0) m: this is another array");
  source.header.reset();
  EXPECT_TRUE(same_array(pair.calibration, "a.json", source)) << "a pose table has no places";
}

TEST(CalibrationFile, AnEmptyFileIsNoPoseTableIfItsNameSaysCalibration) {
  const test::TempDir dir;
  const std::string path = (dir / "empty.json").string();
  { const std::ofstream empty(path); }
  const auto read = calibration_of(path, {});
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().text(), ::testing::Not(HasSubstr("header row")));
}

TEST(CalibrationFile, AHistoryIsOfOneArrayAndHasDates) {
  const Pair pair;
  calib::calibration::Calibration later = pair.calibration;
  const store::PlacedFile first{"a.json", pair.calibration.geometry};
  later.reference.t_utc = "2026-05-11T08:00:00Z";
  EXPECT_TRUE(continues(first, later, "b.json"));
  later.geometry = geometry_of({{0.25, 0, 0}, {-0.3, 0, 0}});
  EXPECT_THAT(continues(first, later, "b.json").error().message, HasSubstr("this is another array"));
  later.reference.t_utc.clear();
  EXPECT_THAT(continues(first, later, "b.json").error().message, HasSubstr("when it was measured"));
}

}  // namespace
}  // namespace mgtd::daemon::cli
