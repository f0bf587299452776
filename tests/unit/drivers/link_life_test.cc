// SPDX-License-Identifier: Apache-2.0
#include "drivers/link_life.h"

#include <gtest/gtest.h>

namespace mgtd::drivers {
namespace {

LinkHealth live() {
  LinkHealth out;
  out.state = LinkState::live;
  return out;
}

FieldReading reading(double t_s, double x_nT, bool saturated = false) {
  FieldReading out;
  out.arrival = {Instant{from_seconds(t_s)}, {}};
  out.y_nT = {x_nT, 2, 3};
  if (saturated) out.flags |= Flag::saturated;
  return out;
}

TEST(LinkLife, APortThatNeverWasIsAbsentAndOneThatWentIsGone) {
  LinkLife life;
  EXPECT_EQ(life.shown({}).state, LinkState::absent);
  const Error missing{ErrorCode::unreachable, "/dev/x: there is no such port", "plug it in"};
  life.refused(missing);
  EXPECT_EQ(life.shown(live()).state, LinkState::absent);
  EXPECT_NE(life.shown({}).detail.find("no such port"), std::string::npos);
  life.opened();
  EXPECT_EQ(life.shown(live()).state, LinkState::live);
  life.lost("/dev/x: the port is gone");
  EXPECT_EQ(life.shown(live()).state, LinkState::gone);
  life.refused(missing);
  EXPECT_EQ(life.shown(live()).state, LinkState::gone) << "it was there";
  life.opened();
  EXPECT_EQ(life.shown(live()).state, LinkState::live);
}

TEST(LinkLife, APortThatAnotherProgramHoldsIsNotAbsent) {
  LinkLife life;
  life.refused({ErrorCode::io, "/dev/x: the port is in use by another program", "stop it"});
  EXPECT_EQ(life.shown({}).state, LinkState::opening);
  EXPECT_NE(life.shown({}).detail.find("in use"), std::string::npos);
}

TEST(LinkLife, WaitsDoubleToTwoSecondsAndStartAgainAfterALiveDevice) {
  LinkLife life;
  const double expected[] = {0.25, 0.5, 1, 2, 2, 2};
  for (const double s : expected) EXPECT_EQ(life.next_wait(), from_seconds(s));
  life.opened();  // opens and closes at once, again and again: the wait stays long
  life.lost("gone");
  EXPECT_EQ(life.next_wait(), from_seconds(2));
  life.opened();
  life.live();
  life.lost("gone");
  EXPECT_EQ(life.next_wait(), from_seconds(0.25));
}

TEST(LinkLife, APortThatIsNotThereIsLookedForFourTimesASecondForEver) {
  LinkLife life;
  const Error missing{ErrorCode::unreachable, "/dev/x: there is no such port", "plug it in"};
  const Error in_use{ErrorCode::io, "/dev/x: the port is in use by another program", "stop it"};
  for (int hour = 0; hour < 1000; ++hour) {
    life.refused(missing);
    ASSERT_EQ(life.next_wait(), from_seconds(0.25));
  }
  const double growing[] = {0.25, 0.5, 1, 2, 2};
  for (const double s : growing) {
    life.refused(in_use);
    EXPECT_EQ(life.next_wait(), from_seconds(s));
  }
  life.refused(missing);  // pulled out: what is plugged in next is tried at once
  EXPECT_EQ(life.next_wait(), from_seconds(0.25));
  life.refused(in_use);
  EXPECT_EQ(life.next_wait(), from_seconds(0.25));
  life.refused(in_use);
  EXPECT_EQ(life.next_wait(), from_seconds(0.5));
}

/// Whenever in the absence the plug goes in again, the port is tried within a quarter of a second of it.
TEST(LinkLife, AReplugIsNoticedWithinAQuarterOfASecond) {
  for (double away_s = 0.01; away_s < 30; away_s *= 1.3) {
    LinkLife life;
    life.opened();
    life.live();
    life.lost("/dev/x: the port is gone");
    double t_s = to_seconds(life.next_wait());
    while (t_s < away_s) {
      life.refused({ErrorCode::unreachable, "/dev/x: there is no such port", "plug it in"});
      t_s += to_seconds(life.next_wait());
    }
    EXPECT_LE(t_s - away_s, 0.25) << away_s;
  }
}

TEST(LinkLife, OneAndTheSameReadingForTwoSecondsIsFrozenAndAnotherOneIsNot) {
  LinkLife life;
  life.opened();
  double t_s = 0;
  for (; t_s < 1.9; t_s += 0.02) life.heard(reading(t_s, 7));
  EXPECT_EQ(life.shown(live()).state, LinkState::live);
  for (; t_s < 2.1; t_s += 0.02) life.heard(reading(t_s, 7));
  EXPECT_EQ(life.shown(live()).state, LinkState::frozen);
  EXPECT_FALSE(life.shown(live()).detail.empty());
  life.heard(reading(t_s, 7.01));
  EXPECT_EQ(life.shown(live()).state, LinkState::live);
}

TEST(LinkLife, ASlowDeviceMayRepeatItselfAFewTimes) {
  LinkLife life;
  life.opened();
  for (int k = 0; k < LinkLife::kFrozenReadings; ++k) life.heard(reading(k, 7));
  EXPECT_EQ(life.shown(live()).state, LinkState::live);
}

TEST(LinkLife, TheEndOfTheRangeIsSaturatedAndNotFrozen) {
  LinkLife life;
  life.opened();
  double t_s = 0;
  for (; t_s < 5; t_s += 0.02) life.heard(reading(t_s, 100'000, true));
  EXPECT_EQ(life.shown(live()).state, LinkState::saturated);
  life.heard(reading(t_s, 90'000));
  EXPECT_EQ(life.shown(live()).state, LinkState::live);
}

TEST(LinkLife, ASilentDeviceStaysSilentWhateverItSaidBefore) {
  LinkLife life;
  life.opened();
  for (double t_s = 0; t_s < 5; t_s += 0.02) life.heard(reading(t_s, 7));
  LinkHealth silent;
  silent.state = LinkState::silent;
  EXPECT_EQ(life.shown(silent).state, LinkState::silent);
  life.lost("gone");
  life.opened();
  EXPECT_EQ(life.shown(live()).state, LinkState::live) << "a fresh port, a fresh look";
}

}  // namespace
}  // namespace mgtd::drivers
