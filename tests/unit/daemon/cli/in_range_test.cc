// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/in_range.h"

#include <gtest/gtest.h>

namespace mgtd::daemon::cli {
namespace {

std::string complaint(const CLI::Validator& validator, std::string given) { return validator(given); }

TEST(InRange, BothEndsAreInside) {
  const auto baseline = in_range(0.05, 10, "m");
  EXPECT_EQ(complaint(baseline, "0.05"), "");
  EXPECT_EQ(complaint(baseline, "10"), "");
  EXPECT_EQ(complaint(baseline, "0.0499"), "0.0499 is not possible: it must be 0.05 to 10 m");
  EXPECT_NE(complaint(baseline, "-0.4"), "");
}

TEST(InRange, AboveZeroLeavesZeroOut) {
  const auto sd = above_zero(10, "deg");
  EXPECT_EQ(complaint(sd, "1e-9"), "");
  EXPECT_EQ(complaint(sd, "10"), "");
  EXPECT_EQ(complaint(sd, "0"), "0 is not possible: it must be above 0 and up to 10 deg");
  EXPECT_NE(complaint(sd, "10.01"), "");
}

/// The library takes -1 for the largest number that there is.
TEST(InRange, ASeedIsAWholeNumberFromZero) {
  for (const char* given : {"0", "7", "18446744073709551615"})
    EXPECT_EQ(complaint(seed_number(), given), "") << given;
  for (const char* given : {"-1", "1.5", "", "+-1"}) EXPECT_NE(complaint(seed_number(), given), "") << given;
}

TEST(InRange, WhatIsNoNumberIsInNoRange) {
  for (const char* given : {"nan", "inf", "-inf", "", "0.4m", "1e999"})
    EXPECT_NE(complaint(in_range(0.05, 1e300, "m"), given), "") << given;
}

}  // namespace
}  // namespace mgtd::daemon::cli
