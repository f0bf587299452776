// SPDX-License-Identifier: Apache-2.0
#include "daemon/acquire/instrument_watch.h"

#include <gmock/gmock.h>

namespace mgtd::daemon::acquire {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

InstrumentIdentity at(const std::string& place, const std::string& serial) {
  return {place, serial.empty() ? "<obsDAQ V5.5.7>" : "<obsDAQ V5.5.7>, serial " + serial};
}

InstrumentWatch of_four() {
  InstrumentWatch watch;
  watch.want({at("s1", "11"), at("s2", "12"), at("s3", "13"), at("s4", "14"), at("table", "9")});
  for (const char* place : {"s1", "s2", "s3", "s4"}) watch.answers(at(place, std::string("1") + place[1]));
  return watch;
}

TEST(InstrumentWatch, TheSameInTheirPlacesAreNoNews) {
  InstrumentWatch watch = of_four();
  EXPECT_FALSE(watch.another());
  EXPECT_EQ(watch.measured(), "");
  watch.answers(at("table", "10"));
  EXPECT_FALSE(watch.another()) << "a table is not judged";
  watch.answers({"s2", "<obsDAQ V6.0.0>, serial 12"});
  EXPECT_FALSE(watch.another()) << "the number counts, not the firmware";
}

TEST(InstrumentWatch, AnExchangeIsNamedOnceWithBothNumbers) {
  InstrumentWatch watch = of_four();
  watch.answers(at("s2", "14"));
  EXPECT_EQ(watch.measured(),
            "the device with serial number 14, calibrated as s4, now answers on the port of s2");
  watch.answers(at("s4", "12"));
  EXPECT_THAT(watch.others(), ElementsAre("s2", "s4"));
  EXPECT_EQ(
      watch.measured(),
      "s2 and s4 are exchanged: the device with serial number 12, calibrated as s2, now answers on the "
      "port of s4, and the device with serial number 14, calibrated as s4, now answers on the port of s2");
  EXPECT_THAT(watch.remedy(), HasSubstr("swap the plugs back"));
}

TEST(InstrumentWatch, AStrangerIsNamedWithTheOneThatWasThere) {
  InstrumentWatch watch = of_four();
  watch.answers(at("s3", "77"));
  EXPECT_EQ(
      watch.measured(),
      "another device answers as s3: serial number 77, and the calibration was made with serial number 13");
  EXPECT_THAT(watch.remedy(), HasSubstr("calibrate anew"));
}

TEST(InstrumentWatch, OneThatDoesNotTellIsJudgedByItsModel) {
  InstrumentWatch watch = of_four();
  watch.answers(at("s3", ""));
  EXPECT_FALSE(watch.another());
  watch.answers({"s3", "another make"});
  EXPECT_TRUE(watch.another());
}

TEST(InstrumentWatch, NothingWantedJudgesNothing) {
  InstrumentWatch watch;
  watch.answers(at("s1", "11"));
  EXPECT_FALSE(watch.another());
  EXPECT_FALSE(watch.wants());
}

}  // namespace
}  // namespace mgtd::daemon::acquire
