// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/stretch_scan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib/fit/joint/joint_fit.h"
#include "calib/report/outlier_text.h"
#include "tests/accuracy/contamination.h"

namespace mgtd::calib::fit::joint {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kFiveSigma_nT = 0.25;

PoseTable clean_run() { return mgtd::testing::contaminated_scene().run(7); }

/// Adds (size, -size, size) to the sensor in the poses from `first` to `last`.
PoseTable shifted(std::size_t sensor, std::size_t first, std::size_t last) {
  PoseTable table = clean_run();
  for (std::size_t k = first; k <= last; ++k)
    table.poses[k].y_nT[sensor] += kFiveSigma_nT * Eigen::Vector3d{1, -1, 1};
  return table;
}

std::vector<std::string> left_out_of(const PoseTable& table) {
  const auto fit = fit_joint(table, {});
  if (!fit) throw std::runtime_error(fit.error().text());
  return report::outlier_texts(fit->outliers);
}

TEST(StretchScan, LeavesOutTheSensorThatIsShiftedInTheMiddleOfTheRun) {
  EXPECT_THAT(left_out_of(shifted(2, 60, 79)),
              ElementsAre(HasSubstr("poses 61-80 disturbed: sensor s3 contradicts")));
}

TEST(StretchScan, LeavesNothingOutOfACleanRun) { EXPECT_THAT(left_out_of(clean_run()), IsEmpty()); }

/// An offset that changed for good looks the same.
TEST(StretchScan, KeepsAShiftThatLastsToTheEndOfTheRun) {
  const PoseTable table = clean_run();
  EXPECT_THAT(left_out_of(shifted(2, 130, table.poses.size() - 1)), IsEmpty());
}

/// Turned a little in its seat, the sensor reads shifts that differ from pose to pose; over a few poses of
/// like attitude they are alike.
TEST(StretchScan, KeepsTheReadingsOfASensorThatMovedForGood) {
  for (const double turn_rad : {2e-6, 3e-6, 4e-6, 6e-6}) {
    for (const std::size_t from : {30U, 60U, 90U, 120U}) {
      PoseTable table = clean_run();
      for (std::size_t k = from; k < table.poses.size(); ++k) {
        Eigen::Vector3d& y = table.poses[k].y_nT[2];
        y += turn_rad * Eigen::Vector3d{0.5, -0.3, 0.8}.cross(y);
      }
      EXPECT_THAT(left_out_of(table), IsEmpty()) << turn_rad << " rad, from pose " << from;
    }
  }
}

}  // namespace
}  // namespace mgtd::calib::fit::joint
