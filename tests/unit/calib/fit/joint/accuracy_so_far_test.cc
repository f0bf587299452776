// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/accuracy_so_far.h"

#include <gtest/gtest.h>

#include "calib/fit/method_choice/fit.h"
#include "tests/unit/calib/fit/simulated_poses.h"

namespace mgtd::calib::fit::joint {
namespace {

TEST(AccuracySoFar, GrowsWithThePosesAndEndsWhereTheWholeFitDoes) {
  const PoseTable whole = testing::simulate({.table_sd_rad = to_rad(0.1)}, 36, 121, 3);
  PoseTable table;
  std::optional<AccuracySoFar> last;
  double with_40 = 0;
  for (const Pose& pose : whole.poses) {
    table.poses.push_back(pose);
    auto known = accuracy_so_far(table, {}, last ? &last->state : nullptr);
    // A level turn does not tell: the random poses do.
    EXPECT_EQ(known.has_value(), table.poses.size() > 36) << table.poses.size();
    if (!known) continue;
    last = *std::move(known);
    EXPECT_EQ(last->poses, static_cast<int>(table.poses.size()));
    if (table.poses.size() == 40) with_40 = last->worst_nT_per_m();
  }
  const auto report = method_choice::fit(whole, {});
  ASSERT_TRUE(report && last);
  EXPECT_NEAR(last->worst_nT_per_m(), report->tensor_sd_nT_per_m.zz, 0.02 * report->tensor_sd_nT_per_m.zz);
  EXPECT_GT(with_40, 2 * last->worst_nT_per_m());
}

}  // namespace
}  // namespace mgtd::calib::fit::joint
