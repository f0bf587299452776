// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/scale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace mgtd::calib::report::figures {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Scale, PutsTheEndsAtTheirPlaces) {
  const Scale down({-2, 2}, 100, 0);
  EXPECT_DOUBLE_EQ(down(-2), 100);
  EXPECT_DOUBLE_EQ(down(0), 50);
  EXPECT_DOUBLE_EQ(down(2), 0);
  const Scale log({0.01, 100}, 0, 40, ScaleKind::log);
  EXPECT_NEAR(log(0.1), 10, 1e-12);
  EXPECT_NEAR(log(1), 20, 1e-12);
}

TEST(Scale, AnEmptyRangeIsWidened) {
  for (const double v : {0.0, 5.0, -1e-9, 1e300}) {
    const Scale scale({v, v}, 0, 100);
    EXPECT_NEAR(scale(v), 50, 1e-6) << v;
  }
  const Scale log({3, 3}, 0, 100, ScaleKind::log);
  EXPECT_NEAR(log(3), 50, 1e-9);
  EXPECT_TRUE(std::isfinite(Scale({0, -1}, 0, 100, ScaleKind::log)(1)));
}

TEST(Scale, HoldsWhatIsFiniteAndInside) {
  const Scale linear({0, 10}, 0, 1), log({1, 10}, 0, 1, ScaleKind::log);
  EXPECT_TRUE(linear.holds(10));
  EXPECT_FALSE(linear.holds(10.1));
  EXPECT_FALSE(linear.holds(kNaN));
  EXPECT_FALSE(linear.holds(std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(log.holds(0));
  EXPECT_FALSE(log.holds(-1));
}

TEST(Range, IsThatOfTheValuesThatCount) {
  const std::vector<double> values{kNaN, 2, -1, 4};
  const Range r = range_of(values, ScaleKind::linear, 0.1);
  EXPECT_DOUBLE_EQ(r.from, -1.5);
  EXPECT_DOUBLE_EQ(r.to, 4.5);
  const Range log = range_of(values, ScaleKind::log, 0);
  EXPECT_DOUBLE_EQ(log.from, 2);
  EXPECT_DOUBLE_EQ(log.to, 4);
  const Range none = range_of(std::vector<double>{kNaN});
  EXPECT_LT(none.from, none.to);
  const Range even = symmetric_range_of(std::vector<double>{-3, 1}, 0);
  EXPECT_DOUBLE_EQ(even.from, -3);
  EXPECT_DOUBLE_EQ(even.to, 3);
}

}  // namespace
}  // namespace mgtd::calib::report::figures
