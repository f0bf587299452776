// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/watchdog_feed.h"

#include <gtest/gtest.h>

namespace mgtd::daemon::app {
namespace {

Instant at(double s) { return Instant{from_seconds(s)}; }

/// Words in 100 seconds, asked once a second; `published` and `epochs` as functions of the second.
template <class Published, class Epochs>
int words(Published published, Epochs epochs) {
  WatchdogFeed feed(std::chrono::seconds{10});
  int out = 0;
  for (std::uint64_t s = 0; s < 100; ++s) out += feed.is_due(published(s), epochs(s), at(double(s))) ? 1 : 0;
  return out;
}

TEST(WatchdogFeed, SpeaksTwiceAPeriodWhileDataMove) {
  EXPECT_EQ(words([](auto s) { return 50 * s; }, [](auto s) { return 50 * s; }), 20);
}

TEST(WatchdogFeed, HonestGapsAreMovement) {
  EXPECT_EQ(words([](auto s) { return 50 + s; }, [](auto) { return 50U; }), 20);
}

TEST(WatchdogFeed, WaitsForInstrumentsThatAreNotThereYet) {
  EXPECT_EQ(words([](auto) { return 0U; }, [](auto) { return 0U; }), 20);
}

TEST(WatchdogFeed, StarvesWhenTheDataStandStill) {
  const auto until_30 = [](auto s) { return 50 * std::min<std::uint64_t>(s, 30); };
  EXPECT_EQ(words(until_30, until_30), 7) << "every five seconds up to the thirtieth, then never again";
}

}  // namespace
}  // namespace mgtd::daemon::app
