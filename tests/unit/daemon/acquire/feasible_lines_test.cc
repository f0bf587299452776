// SPDX-License-Identifier: Apache-2.0
#include "daemon/acquire/feasible_lines.h"

#include <gtest/gtest.h>

#include <random>

namespace mgtd::daemon::acquire {
namespace {

FeasibleLines wide() {
  FeasibleLines lines;
  lines.start(0, {-1, 0}, {0.01, 0.03});
  return lines;
}

TEST(FeasibleLines, ObservationsCutTheTimesBetweenThem) {
  FeasibleLines lines = wide();
  EXPECT_NEAR(lines.time(0).least, -1, 1e-12);
  EXPECT_NEAR(lines.time(0).most, 0, 1e-12);
  EXPECT_NEAR(lines.time(100).most, 3, 1e-12);
  EXPECT_TRUE(lines.not_above(100, 2));
  EXPECT_TRUE(lines.not_below(100, 1.999));
  EXPECT_NEAR(lines.time(100).least, 1.999, 1e-12);
  EXPECT_NEAR(lines.time(100).most, 2, 1e-12);
  EXPECT_NEAR(lines.period().least, 0.01999, 1e-9);  // through 0 at 0
  EXPECT_NEAR(lines.period().most, 0.03, 1e-12);
}

TEST(FeasibleLines, AContradictionIsRefusedAndChangesNothing) {
  FeasibleLines lines = wide();
  ASSERT_TRUE(lines.not_above(100, 2));
  EXPECT_FALSE(lines.not_below(100, 2.1));
  EXPECT_NEAR(lines.time(100).most, 2, 1e-12);
  EXPECT_FALSE(lines.not_above(0, -1.1));
  EXPECT_NEAR(lines.time(0).least, -1, 1e-12);
}

TEST(FeasibleLines, WanderWidensThePeriodAndWithTimeTheTime) {
  FeasibleLines lines;
  lines.start(0, {-1e-6, 0}, {0.02 - 1e-9, 0.02 + 1e-9});
  lines.allow_wander(50, 1e-6);
  EXPECT_NEAR(lines.period().most - lines.period().least, 2.002e-6, 1e-12);
  EXPECT_NEAR(lines.time(50).most, 1 + 50 * 1.001e-6, 1e-12);
  EXPECT_NEAR(lines.time(50).least, 1 - 50 * 1.001e-6 - 1e-6, 1e-12);
}

TEST(FeasibleLines, TheHighestLineIsOneOfTheWantedPeriodsWhereThereIsOne) {
  const FeasibleLines lines = wide();
  EXPECT_NEAR(lines.highest_at(100, {0.019, 0.021}).period_s, 0.021, 1e-12);
  EXPECT_NEAR(lines.highest_at(100, {0.019, 0.021}).t_s, 2.1, 1e-12);
  EXPECT_NEAR(lines.highest_at(100, {0.05, 0.06}).t_s, 3, 1e-12);
}

/// Thousands of random half-planes and widenings: the true line stays inside, and the bound stays narrow.
TEST(FeasibleLines, TheTruthStaysInsideHoweverManyCornersAreGivenUp) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> delay(0, 0.016);
  FeasibleLines lines;
  const auto truth = [](double k) { return 3 + 0.0200013 * k; };
  lines.start(0, {2, 3.016}, {0.018, 0.022});
  for (int k = 1; k < 200'000; ++k) {
    const double arrival_s = truth(k) + delay(random);
    ASSERT_TRUE(lines.not_above(k, arrival_s));
    ASSERT_TRUE(lines.not_below(k, arrival_s - 0.016));
    if (k % 50 == 0) lines.allow_wander(k, 1e-11);
    if (k % 1000 != 0) continue;
    const FeasibleLines::Range t_s = lines.time(k);
    ASSERT_LE(t_s.least, truth(k) + 1e-9);
    ASSERT_GE(t_s.most, truth(k) - 1e-9);
    if (k > 10'000) {
      ASSERT_LT(t_s.most - t_s.least, 1e-3);
    }
  }
}

}  // namespace
}  // namespace mgtd::daemon::acquire
