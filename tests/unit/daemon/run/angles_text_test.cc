// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/angles_text.h"

#include <gtest/gtest.h>

#include "proto/units.h"

namespace mgtd::daemon::run {
namespace {

TEST(AnglesText, IsToAHundredthOfADegree) {
  EXPECT_EQ(angles_text({to_rad(90.0), to_rad(-45.126), to_rad(0.5)}),
            "azimuth 90.00, pitch -45.13, roll 0.50 deg");
}

TEST(AnglesText, ZeroHasNoSign) {
  EXPECT_EQ(angles_text({to_rad(-0.001), -0.0, to_rad(0.001)}), "azimuth 0.00, pitch 0.00, roll 0.00 deg");
}

}  // namespace
}  // namespace mgtd::daemon::run
