// SPDX-License-Identifier: Apache-2.0
#include "calib/stats/median.h"

#include <gtest/gtest.h>

#include <limits>

namespace mgtd::calib::stats {
namespace {

TEST(Median, OfAnOddNumberIsTheMiddleOne) { EXPECT_EQ(median({5, -2, 9}), 5); }

TEST(Median, OfAnEvenNumberIsTheUpperOfTheMiddleTwo) { EXPECT_EQ(median({4, 1, 3, 2}), 3); }

TEST(Median, OfNoneIsZero) { EXPECT_EQ(median({}), 0); }

TEST(Median, HoldsUntilHalfOfTheValuesAreInfinite) {
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(median({1, inf, 2, inf, 3}), 3);
  EXPECT_EQ(median({1, inf, inf, 2}), inf);
}

}  // namespace
}  // namespace mgtd::calib::stats
