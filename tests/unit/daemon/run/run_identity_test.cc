// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/run_identity.h"

#include <gmock/gmock.h>

namespace mgtd::daemon::run {
namespace {

using ::testing::HasSubstr;

InstrumentIdentity sensor(const std::string& place, const std::string& serial) {
  return {place, "obsDAQ V5.5.7, serial " + serial};
}

TEST(RunIdentity, AnotherSensorThanTheCalibratedOneIsMeantSoAfterOneQuestion) {
  RunIdentity identity({sensor("s1", "1001")}, {});
  EXPECT_FALSE(identity.answers(sensor("s1", "2001"))) << "the run has no sensors of its own yet";
  const Check check = identity.check();
  EXPECT_FALSE(check.passed);
  EXPECT_THAT(check.measured, HasSubstr("2001"));
  identity.ask_once(check);
  EXPECT_TRUE(identity.check().passed);
  EXPECT_EQ(identity.begin().size(), 1U);
  EXPECT_TRUE(identity.begin().empty()) << "they are known";
}

TEST(RunIdentity, AnotherSensorThanThatOfTheRunIsNeverMeantSo) {
  RunIdentity identity({}, {sensor("s1", "1001")});
  EXPECT_TRUE(identity.answers(sensor("s1", "2001")));
  EXPECT_FALSE(identity.answers(sensor("s1", "2001"))) << "that was said";
  identity.ask_once(identity.check());
  EXPECT_FALSE(identity.check().passed);
  EXPECT_TRUE(identity.answers(sensor("s1", "1001")));
  EXPECT_EQ(identity.exchanged(), "");
  EXPECT_TRUE(identity.check().passed);
}

TEST(RunIdentity, WhatTheReadingsSayIsNewOnce) {
  RunIdentity identity({}, {});
  EXPECT_FALSE(identity.readings_say({}));
  EXPECT_TRUE(identity.readings_say({"s2 and s4 are exchanged", "look at the plugs"}));
  EXPECT_FALSE(identity.readings_say({"s2 and s4 are exchanged", "look at the plugs"}));
}

}  // namespace
}  // namespace mgtd::daemon::run
