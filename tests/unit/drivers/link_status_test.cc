// SPDX-License-Identifier: Apache-2.0
#include "drivers/link_status.h"

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

TEST(LinkStatus, APortThatNeverWasIsAbsentAndOneThatWentIsGone) {
  LinkStatus status;
  EXPECT_EQ(status.shown({}).state, LinkState::absent);
  const Error missing{ErrorCode::unreachable, "/dev/x: there is no such port", "plug it in"};
  status.refused(missing);
  EXPECT_EQ(status.shown(live()).state, LinkState::absent);
  EXPECT_NE(status.shown({}).detail.find("no such port"), std::string::npos);
  status.opened();
  EXPECT_EQ(status.shown(live()).state, LinkState::live);
  status.lost("/dev/x: the port is gone");
  EXPECT_EQ(status.shown(live()).state, LinkState::gone);
  status.refused(missing);
  EXPECT_EQ(status.shown(live()).state, LinkState::gone) << "it was there";
  status.opened();
  EXPECT_EQ(status.shown(live()).state, LinkState::live);
}

TEST(LinkStatus, APortThatAnotherProgramHoldsIsNotAbsent) {
  LinkStatus status;
  status.refused({ErrorCode::io, "/dev/x: the port is in use by another program", "stop it"});
  EXPECT_EQ(status.shown({}).state, LinkState::opening);
  EXPECT_NE(status.shown({}).detail.find("in use"), std::string::npos);
}

TEST(LinkStatus, WaitsDoubleToTwoSecondsAndStartAgainAfterALiveDevice) {
  LinkStatus status;
  const double expected[] = {0.25, 0.5, 1, 2, 2, 2};
  for (const double s : expected) EXPECT_EQ(status.next_wait(), from_seconds(s));
  status.opened();  // opens and closes at once, again and again: the wait stays long
  status.lost("gone");
  EXPECT_EQ(status.next_wait(), from_seconds(2));
  status.opened();
  status.live();
  status.lost("gone");
  EXPECT_EQ(status.next_wait(), from_seconds(0.25));
}

TEST(LinkStatus, APortThatIsNotThereIsLookedForFourTimesASecondForEver) {
  LinkStatus status;
  const Error missing{ErrorCode::unreachable, "/dev/x: there is no such port", "plug it in"};
  const Error in_use{ErrorCode::io, "/dev/x: the port is in use by another program", "stop it"};
  for (int hour = 0; hour < 1000; ++hour) {
    status.refused(missing);
    ASSERT_EQ(status.next_wait(), from_seconds(0.25));
  }
  const double growing[] = {0.25, 0.5, 1, 2, 2};
  for (const double s : growing) {
    status.refused(in_use);
    EXPECT_EQ(status.next_wait(), from_seconds(s));
  }
  status.refused(missing);  // pulled out: what is plugged in next is tried at once
  EXPECT_EQ(status.next_wait(), from_seconds(0.25));
  status.refused(in_use);
  EXPECT_EQ(status.next_wait(), from_seconds(0.25));
  status.refused(in_use);
  EXPECT_EQ(status.next_wait(), from_seconds(0.5));
}

/// Whenever in the absence the plug goes in again, the port is tried within a quarter of a second of it.
TEST(LinkStatus, AReplugIsNoticedWithinAQuarterOfASecond) {
  for (double away_s = 0.01; away_s < 30; away_s *= 1.3) {
    LinkStatus status;
    status.opened();
    status.live();
    status.lost("/dev/x: the port is gone");
    double t_s = to_seconds(status.next_wait());
    while (t_s < away_s) {
      status.refused({ErrorCode::unreachable, "/dev/x: there is no such port", "plug it in"});
      t_s += to_seconds(status.next_wait());
    }
    EXPECT_LE(t_s - away_s, 0.25) << away_s;
  }
}

TEST(LinkStatus, OneAndTheSameReadingForTwoSecondsIsFrozenAndAnotherOneIsNot) {
  LinkStatus status;
  status.opened();
  double t_s = 0;
  for (; t_s < 1.9; t_s += 0.02) status.heard(reading(t_s, 7));
  EXPECT_EQ(status.shown(live()).state, LinkState::live);
  for (; t_s < 2.1; t_s += 0.02) status.heard(reading(t_s, 7));
  EXPECT_EQ(status.shown(live()).state, LinkState::frozen);
  EXPECT_FALSE(status.shown(live()).detail.empty());
  status.heard(reading(t_s, 7.01));
  EXPECT_EQ(status.shown(live()).state, LinkState::live);
}

TEST(LinkStatus, ASlowDeviceMayRepeatItselfAFewTimes) {
  LinkStatus status;
  status.opened();
  for (int k = 0; k < LinkStatus::kFrozenReadings; ++k) status.heard(reading(k, 7));
  EXPECT_EQ(status.shown(live()).state, LinkState::live);
}

TEST(LinkStatus, TheEndOfTheRangeIsSaturatedAndNotFrozen) {
  LinkStatus status;
  status.opened();
  double t_s = 0;
  for (; t_s < 5; t_s += 0.02) status.heard(reading(t_s, 100'000, true));
  EXPECT_EQ(status.shown(live()).state, LinkState::saturated);
  status.heard(reading(t_s, 90'000));
  EXPECT_EQ(status.shown(live()).state, LinkState::live);
}

TEST(LinkStatus, ASilentDeviceStaysSilentWhateverItSaidBefore) {
  LinkStatus status;
  status.opened();
  for (double t_s = 0; t_s < 5; t_s += 0.02) status.heard(reading(t_s, 7));
  LinkHealth silent;
  silent.state = LinkState::silent;
  EXPECT_EQ(status.shown(silent).state, LinkState::silent);
  status.lost("gone");
  status.opened();
  EXPECT_EQ(status.shown(live()).state, LinkState::live) << "a fresh port, a fresh look";
}

}  // namespace
}  // namespace mgtd::drivers
