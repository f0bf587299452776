// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/enough_samples.h"

#include <gmock/gmock.h>

namespace mgtd::daemon::run {
namespace {

using ::testing::HasSubstr;

plan::RunPlan two_dwells(double short_s, double long_s) {
  plan::RunPlan plan;
  plan.poses.push_back({.number = 1, .set = "random", .dwell_s = long_s});
  plan.poses.push_back({.number = 2, .set = "random", .dwell_s = short_s});
  return plan;
}

RunConfig at_rate(double rate_hz) {
  RunConfig config;
  config.settle.rate_hz = config.dwell.rate_hz = rate_hz;
  return config;
}

TEST(EnoughSamples, ADwellHoldsAtLeastEight) {
  EXPECT_TRUE(enough_samples(two_dwells(0.5, 5), at_rate(50)));
  EXPECT_TRUE(enough_samples(two_dwells(1.6, 5), at_rate(5)));
  const auto refused = enough_samples(two_dwells(1.5, 5), at_rate(5));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("pose 2, 1.5 s, holds 7 samples at 5 Hz, at least 8"));
  EXPECT_THAT(refused.error().remedy, HasSubstr("1.6 s or longer"));
}

TEST(EnoughSamples, TheFieldMayBeSeenToBeSteady) {
  RunConfig quick = at_rate(50);
  quick.settle.min_s = 0.5, quick.settle.max_s = quick.settle.window_s;
  EXPECT_TRUE(enough_samples(two_dwells(5, 5), quick)) << "four fifths of the window suffice";
  EXPECT_TRUE(enough_samples(two_dwells(60, 60), at_rate(0.5)));
  const auto refused = enough_samples(two_dwells(60, 60), at_rate(0.2));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("30 s"));
  EXPECT_THAT(refused.error().message, HasSubstr("settle_max_s = 20 s"));
}

}  // namespace
}  // namespace mgtd::daemon::run
