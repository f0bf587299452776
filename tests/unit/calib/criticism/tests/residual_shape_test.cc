// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/residual_shape.h"

#include <gtest/gtest.h>

#include "calib/criticism/tests/comparison.h"
#include "tests/blind/hidden_run.h"

namespace mgtd::calib::criticism::tests {
namespace {

using calib::testing::hidden_run;

std::shared_ptr<const fit::joint::JointFit> fit_of(const PoseTable& table) {
  const auto compared = compare(table, {});
  EXPECT_TRUE(compared);
  return compared->fit;
}

std::size_t outside(const ResidualQuantiles& q) {
  std::size_t out = 0;
  for (std::size_t i = 0; i < q.residual.size(); ++i)
    out += q.residual[i] < q.low[i] || q.residual[i] > q.high[i] ? 1U : 0U;
  return out;
}

TEST(NormalQuantile, IsThatOfTheTables) {
  EXPECT_NEAR(normal_quantile(0.5), 0, 1e-9);
  EXPECT_NEAR(normal_quantile(0.975), 1.959964, 1e-6);
  EXPECT_NEAR(normal_quantile(1e-6), -4.753424, 1e-6);
}

TEST(ResidualQuantiles, OfPureNoiseLieInTheEnvelope) {
  const PoseTable table = hidden_run({}, 6);
  const ResidualQuantiles q = residual_quantiles(*fit_of(table));
  EXPECT_EQ(q.n, 12 * table.poses.size());
  EXPECT_EQ(outside(q), 0U);
  for (std::size_t i = 0; i < q.quantile.size(); ++i) {
    EXPECT_LT(q.low[i], q.quantile[i]);
    EXPECT_GT(q.high[i], q.quantile[i]);
    if (i > 0) {
      EXPECT_GE(q.residual[i], q.residual[i - 1]);
    }
  }
  EXPECT_LE(q.quantile.size(), kMostQuantiles + 50);
}

/// Three readings of 15 standard deviations are left out by the fit; heavy tails stay.
TEST(ResidualQuantiles, HeavyTailsLeaveTheEnvelope) {
  const PoseTable table = hidden_run({.tail = calib::testing::Tail::student3}, 6);
  EXPECT_GT(outside(residual_quantiles(*fit_of(table))), 3U);
}

TEST(ResidualAutocorrelation, TellsNoiseThatRemembers) {
  const PoseTable clean = hidden_run({}, 6), slow = hidden_run({.rho = 0.7}, 6);
  const ResidualAutocorrelation none = residual_autocorrelation(*fit_of(clean)),
                                some = residual_autocorrelation(*fit_of(slow));
  ASSERT_EQ(none.by_sensor.size(), 4U);
  ASSERT_EQ(none.by_sensor[0].size(), 20U);
  EXPECT_NEAR(none.bound, 1.96 / std::sqrt(3 * 157.0), 1e-12);
  int off = 0;
  for (const auto& sensor : none.by_sensor)
    for (const double r : sensor) off += std::abs(r) > none.bound ? 1 : 0;
  EXPECT_LE(off, 10);  // 4 of 80 by chance
  for (const auto& sensor : some.by_sensor) {
    EXPECT_GT(sensor[0], 0.4);
    EXPECT_GT(sensor[0], sensor[3]);
  }
}

}  // namespace
}  // namespace mgtd::calib::criticism::tests
