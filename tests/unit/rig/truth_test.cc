// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/truth.h"

#include <gtest/gtest.h>

namespace mgtd::rig {
namespace {

/// As they were drawn before there was any other array.
TEST(Truth, TheFirstRandomSensorsAreThoseOfTheCross) {
  const RigTruth cross = rig_named("random", 5).value(), eight = rig_named("random", 5, 8).value();
  ASSERT_EQ(cross.size(), 4U);
  ASSERT_EQ(eight.size(), 8U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(cross[i].matrix(), eight[i].matrix());
    EXPECT_EQ(cross[i].offset_nT, eight[i].offset_nT);
  }
  EXPECT_NE(eight[4].offset_nT, eight[0].offset_nT);
  EXPECT_NEAR(cross[0].theta_deg, 0.430075332772867, 1e-12);
  EXPECT_NEAR(cross[3].offset_nT[2], 264.69647486051497, 1e-9);
}

TEST(Truth, PublishedParametersAreOfFourSensors) {
  EXPECT_TRUE(rig_named("table3", 1, 4).has_value());
  EXPECT_FALSE(rig_named("table3", 1, 3).has_value());
  EXPECT_FALSE(rig_named("table6", 1, 8).has_value());
  EXPECT_EQ(rig_named("ideal", 1, 16).value().size(), 16U);
}

}  // namespace
}  // namespace mgtd::rig
