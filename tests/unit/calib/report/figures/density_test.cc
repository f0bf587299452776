// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/density.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "tests/unit/calib/report/figures/examples.h"

namespace mgtd::calib::report::figures {
namespace {

TEST(Density, EveryPointIsCountedOnce) {
  const std::vector<double> x{0, 0.1, 0.5, 1, 1.2, 0.5},
      y{0, 0.1, 0.5, 1, 0.5, std::numeric_limits<double>::quiet_NaN()};
  const BinCounts bins = bin_counts(x, y, 4, 4);
  EXPECT_EQ(std::accumulate(bins.counts.begin(), bins.counts.end(), 0), 4);
  EXPECT_EQ(bins.most, 2);
  EXPECT_EQ(bins.counts.front(), 2);
  EXPECT_EQ(bins.counts.back(), 1);
}

TEST(Density, MeansStandAtTheMeanOfTheirBin) {
  std::vector<double> x, y;
  for (int i = 0; i < 80; ++i) x.push_back(i < 40 ? i : 1000 + i), y.push_back(i < 40 ? 1 : 3);
  const BinnedMeans m = binned_means(x, y, 2);
  ASSERT_EQ(m.means.size(), 2U);
  EXPECT_DOUBLE_EQ(m.centres[0], 19.5);
  EXPECT_DOUBLE_EQ(m.centres[1], 1059.5);
  EXPECT_DOUBLE_EQ(m.means[0], 1);
  EXPECT_DOUBLE_EQ(m.means[1], 3);
  EXPECT_DOUBLE_EQ(m.standard_errors[0], 0);
}

TEST(Density, EqualPlacesStayTogether) {
  const std::vector<double> x{1, 1, 1, 1, 1, 1, 2, 3}, y{1, 2, 3, 4, 5, 6, 7, 8};
  const BinnedMeans m = binned_means(x, y, 4);
  EXPECT_EQ(m.counts.front(), 6U);
  EXPECT_DOUBLE_EQ(m.means.front(), 3.5);
}

TEST(Density, QuantilesAreThoseOfTheValues) {
  std::vector<double> x(101, 0), y;
  for (int i = 0; i <= 100; ++i) y.push_back(100 - i);
  const RunningQuantiles q = running_quantiles(x, y, std::vector{0.1, 0.5, 0.9}, 1);
  EXPECT_DOUBLE_EQ(q.values[0][0], 10);
  EXPECT_DOUBLE_EQ(q.values[1][0], 50);
  EXPECT_DOUBLE_EQ(q.values[2][0], 90);
}

}  // namespace
}  // namespace mgtd::calib::report::figures
