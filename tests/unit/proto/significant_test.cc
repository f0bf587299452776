// SPDX-License-Identifier: Apache-2.0
#include "proto/significant.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace mgtd {
namespace {

TEST(Significant, LeavesSoManyDigits) {
  EXPECT_EQ(significant(0.000012345678), 1.235e-5);
  EXPECT_EQ(significant(-9.9996), -10.0);
  EXPECT_EQ(significant(53'907.7012), 53'910.0);
  EXPECT_EQ(significant(2.5, 1), 3.0);
  EXPECT_EQ(significant(0), 0.0);
}

TEST(Significant, WhatIsNoNumberStaysNone) {
  EXPECT_TRUE(std::isnan(significant(std::nan(""))));
  EXPECT_TRUE(std::isinf(significant(-std::numeric_limits<double>::infinity())));
}

}  // namespace
}  // namespace mgtd
