// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "proto/units.h"
#include "tests/rig/scenario.h"
#include "tests/rig/simulated_table.h"

namespace mgtd::rig {
namespace {

const std::string kList =
    "pose,set,azimuth_deg,pitch_deg,roll_deg,sense,dwell_s,since_stop_s,note\n"
    "1,random,246.97,26.86,-15.50,-1,8,20,warm the heads\n"
    "2,standard,20.00,0.00,0.00,1,4,,\n";

TEST(ListedDesign, ItsPosesAreMeasuredFromTheTimeThatWasAskedFor) {
  ListedDesign listed = listed_design(kList);
  ASSERT_EQ(listed.error, "");
  listed.design.begin_s = 2400;
  const auto scenario = parse_scenario("[rig]\nname = \"a\"\nparameters = \"table6\"\nseed = 3\n", "a.toml");
  ASSERT_TRUE(scenario);
  const PoseTable run = simulated_table(*scenario, listed.design, 3);
  ASSERT_EQ(run.poses.size(), 2U);
  EXPECT_GT(*run.poses[0].t_s, 2415);
  EXPECT_LT(*run.poses[1].t_s, 2500);
  EXPECT_NEAR(*run.poses[0].azimuth_rad, to_rad(246.97), 1e-3);
  EXPECT_NEAR(*run.poses[0].roll_rad, to_rad(-15.5), 1e-3);
  EXPECT_EQ(run.poses[0].sense, -1);
  EXPECT_NEAR(*run.poses[0].since_stop_s, 20, 1e-9);
  EXPECT_EQ(run.poses[1].set, "standard");
  EXPECT_EQ(run.poses[1].dwell_s, 4);
}

TEST(ListedDesign, RefusesWhatIsNoList) {
  EXPECT_NE(listed_design("pose,set\n1,random\n").error, "");
  EXPECT_NE(listed_design("azimuth_deg,pitch_deg,roll_deg\n1,x,3\n").error.find("line 2"), std::string::npos);
  EXPECT_NE(listed_design("azimuth_deg,pitch_deg,roll_deg\n").error, "");
}

}  // namespace
}  // namespace mgtd::rig
