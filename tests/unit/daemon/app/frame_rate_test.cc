// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/frame_rate.h"

#include <gtest/gtest.h>

namespace mgtd::daemon::app {
namespace {

Instant second(double t_s) { return Instant{from_seconds(t_s)}; }

TEST(FrameRate, IsNotKnownFromOneLook) {
  FrameRate rate;
  EXPECT_FALSE(rate.rate_hz());
  rate.add(500, second(10));
  EXPECT_FALSE(rate.rate_hz());
  rate.add(500, second(10));
  EXPECT_FALSE(rate.rate_hz()) << "no time has passed";
}

TEST(FrameRate, AnInstrumentThatSpeaksEveryThirdSecondHasOne) {
  FrameRate rate;
  for (int s = 0; s <= 30; ++s) {
    rate.add(static_cast<std::uint64_t>(s / 3), second(s));
    if (s < 10) continue;
    EXPECT_NEAR(*rate.rate_hz(), 1.0 / 3, 0.1) << s;
  }
}

TEST(FrameRate, ADeviceThatWentSilentHasNoneAfterTenLooks) {
  FrameRate rate;
  for (int s = 0; s <= 20; ++s) rate.add(static_cast<std::uint64_t>(50 * s), second(s));
  EXPECT_EQ(rate.rate_hz(), 50);
  for (int s = 21; s <= 25; ++s) rate.add(1000, second(s));
  EXPECT_EQ(rate.rate_hz(), 25);
  for (int s = 26; s <= 30; ++s) rate.add(1000, second(s));
  EXPECT_EQ(rate.rate_hz(), 0);
}

}  // namespace
}  // namespace mgtd::daemon::app
