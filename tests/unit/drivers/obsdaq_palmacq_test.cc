// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/unit/drivers/obsdaq_bench.h"

namespace mgtd::drivers::obsdaq {
namespace {

TEST(ObsdaqPalmAcq, ConfiguresThroughTransparentModeAndForwards) {
  Instrument instrument;
  instrument.palmacq = true;
  instrument.forwarding = true;  // as a former program left it
  ObsdaqDriver driver(0, settings(true));
  EXPECT_EQ(driver.baud(), 57600);
  DeviceBench bench(driver, std::ref(instrument));
  bench.open();
  ASSERT_TRUE(bench.pass_until([&] { return driver.health().state == LinkState::live; }));
  EXPECT_TRUE(instrument.forwarding);
  EXPECT_FALSE(instrument.transparent);
  EXPECT_EQ(instrument.commands.front(), "SM:CMD");
  EXPECT_EQ(instrument.commands.back(), "SF:R");
  bench.feed("259FEFFF1BFFFFCEDL\r");  // tail of an unstamped line from transparent mode
  bench.feed(":R,00,200131.143739.617,*0259FEFFF1BFFFFCEDL:04AC11CC000B000B000B\r");
  const auto readings = bench.events<FieldReading>();
  ASSERT_EQ(readings.size(), 1U);
  ASSERT_TRUE(readings[0].device_time_s);
  EXPECT_EQ(driver.health().rejected, LinkHealth().rejected);
}

/// What a replug costs beside the second that the trigger needs.
TEST(ObsdaqPalmAcq, ADeviceThatFollowsIsStartedBriskly) {
  for (const bool palmacq : {false, true}) {
    Instrument instrument;
    instrument.palmacq = palmacq;
    ObsdaqDriver driver(0, settings(palmacq));
    DeviceBench bench(driver, std::ref(instrument));
    const double opened_s = bench.t_s();
    bench.open();
    ASSERT_TRUE(bench.pass_until([&] { return driver.health().state == LinkState::live; }));
    EXPECT_LT(bench.t_s() - opened_s, palmacq ? 1.7 : 1.3);
  }
}

/// Deaf for a while after each command that it does not answer: what the long pauses are for.
TEST(ObsdaqPalmAcq, OneThatNeedsItsPausesGetsThemInALaterConversation) {
  Instrument instrument;
  instrument.palmacq = true;
  ObsdaqDriver driver(0, settings(true));
  double now_s = 0, deaf_until_s = 0;
  DeviceBench bench(driver, [&](std::string_view sent) {
    if (now_s < deaf_until_s) return std::string();
    std::string reply = instrument(sent);
    if (reply.empty()) deaf_until_s = now_s + 0.15;
    return reply;
  });
  bench.open();
  ASSERT_TRUE(bench.pass_until([&] {
    now_s = bench.t_s();
    return driver.health().state == LinkState::live && instrument.forwarding && instrument.streaming;
  }));
  EXPECT_FALSE(instrument.transparent);
  EXPECT_TRUE(bench.events<DeviceFault>().empty());
  EXPECT_LT(bench.t_s() - 1000, 10) << "before the port would be opened again";
}

/// It says yes to everything and does not forward: the pauses were too short, or something else is wrong.
TEST(ObsdaqPalmAcq, ABriskStartWithoutASampleIsFollowedByAPatientOne) {
  Instrument instrument;
  instrument.palmacq = true;
  ObsdaqDriver driver(0, settings(true));
  DeviceBench bench(driver, std::ref(instrument));
  bench.open();
  ASSERT_TRUE(bench.pass_until([&] { return driver.health().state == LinkState::live; }));
  ASSERT_TRUE(bench.pass_until([&] { return driver.health().state == LinkState::silent; }));
  const double restarted_s = bench.t_s();
  ASSERT_TRUE(bench.pass_until([&] { return driver.health().state == LinkState::live; }));
  EXPECT_GT(bench.t_s() - restarted_s, 3);
}

/// `palmacq = true`, and the digitiser is on the port itself: it answers every question of its own.
TEST(ObsdaqPalmAcq, ADigitiserWithoutTheTimeStamperIsNeverLiveAndSaysWhatToSet) {
  for (const std::string& mute : {std::string(), std::string("$01M")}) {
    Instrument direct;
    direct.mute = mute;
    ObsdaqDriver driver(0, settings(true));
    DeviceBench bench(driver, std::ref(direct));
    bench.open();
    const bool said = bench.pass_until([&] {
      if (direct.streaming) bench.feed("*0259FEFFF1BFFFFCEDL\r");
      EXPECT_NE(driver.health().state, LinkState::live);
      return driver.health().state == LinkState::failed || driver.health().state == LinkState::silent;
    });
    EXPECT_TRUE(said);
    EXPECT_THAT(driver.health().detail,
                ::testing::HasSubstr("no time-stamper answers: set palmacq = false?"));
    EXPECT_TRUE(bench.events<FieldReading>().empty());
  }
}

TEST(ObsdaqPalmAcq, ADigitiserThatStreamsWithoutTheTimeStamperSaysWhatToSet) {
  ObsdaqDriver driver(0, settings(true));
  DeviceBench bench(driver);
  bench.open();
  ASSERT_TRUE(bench.pass_until([&] {
    bench.feed("*0259FEFFF1BFFFFCEDL\r");
    return driver.health().state == LinkState::failed;
  }));
  EXPECT_THAT(driver.health().detail, ::testing::HasSubstr("no time-stamper answers: set palmacq = false?"));
}

TEST(ObsdaqPalmAcq, AnUnstampedLineIsRejected) {
  Instrument instrument;
  instrument.palmacq = true;
  ObsdaqDriver driver(0, settings(true));
  DeviceBench bench(driver, std::ref(instrument));
  bench.open();
  ASSERT_TRUE(bench.pass_until([&] { return driver.health().state == LinkState::live; }));
  bench.feed(":R,00,200131.143739.617,*0259FEFFF1BFFFFCEDL\r*0259FEFFF1BFFFFCEDL\r");
  EXPECT_EQ(bench.events<FieldReading>().size(), 1U);
  EXPECT_EQ(driver.health().rejected[static_cast<std::size_t>(Reject::framing)], 1U);
}

TEST(ObsdaqPalmAcq, AnImpossibleDateIsSaidOnce) {
  Instrument instrument;
  instrument.palmacq = true;
  ObsdaqDriver driver(0, settings(true));
  DeviceBench bench(driver, std::ref(instrument));
  bench.open();
  ASSERT_TRUE(bench.pass_until([&] { return driver.health().state == LinkState::live; }));
  bench.forget_events();
  for (int i = 0; i < 3; ++i) bench.feed(":R,00,200132.143739.617,*0259FEFFF1BFFFFCEDL\r");
  EXPECT_EQ(bench.events<FieldReading>().size(), 3U);
  EXPECT_FALSE(bench.events<FieldReading>()[0].device_time_s);
  EXPECT_EQ(bench.events<DeviceNote>().size(), 1U);
}

}  // namespace
}  // namespace mgtd::drivers::obsdaq
