// SPDX-License-Identifier: Apache-2.0
#include "drivers/obsdaq_driver.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <set>

#include "drivers/registry.h"
#include "tests/support/device_bench.h"

namespace mgtd::drivers::obsdaq {
namespace {

using mgtd::testing::DeviceBench;
using ::testing::HasSubstr;

/// A digitiser on the bench, optionally behind a PalmAcq; answers as in the captured dialogues.
struct Instrument {
  std::string identity{"!01<obsDAQ V5.5.7>"};
  std::string serial{"1001"};  ///< empty: a firmware that does not know the question
  std::string spoil;           ///< commands that start so are answered by "?01"
  std::string mute;            ///< commands that start so are not answered
  bool palmacq{false};
  bool streaming{false};
  bool transparent{false}, forwarding{false};
  std::string command;
  std::vector<std::string> commands;

  std::string operator()(std::string_view sent) {
    std::string out;
    for (const char c : sent) {
      if (c == '|') {
        streaming = false;
      } else if (c == '\x1B') {
        transparent = false;
        command.clear();
      } else if (c == '\r') {
        commands.push_back(command);
        out += answer(std::exchange(command, {}));
      } else if (c != '\0') {
        command += c;
      }
    }
    return out;
  }

  std::string answer(const std::string& c) {
    if (palmacq && !transparent) {
      if (c == "SM:TRP") transparent = true;
      if (c == "SF:R") forwarding = true;
      if (c == "SF:-") forwarding = false;
      return c == "SM:TRP" ? "AM:TRP,001B\r" : "";
    }
    if (!mute.empty() && c.starts_with(mute)) return "";
    if (!spoil.empty() && c.starts_with(spoil)) return "?01\r";
    if (c == "#01ST") {
      streaming = false;
      return "";
    }
    if (c == "$01M") return identity + "\r";
    if (c == "$01SN" && !serial.empty()) return "!01SN" + serial + "\r";
    if (c.starts_with("#01PP")) return "!01" + c.substr(5) + "\r";
    if (c.size() == 14 && c.substr(4, 2) == "WS") return "!01" + c.substr(6) + "\r";
    if (c == "#01CS") {
      streaming = true;
      return "!01\r";
    }
    return "?01\r";
  }
};

ObsdaqSettings settings(bool palmacq = false) {
  Settings s("[[sensor]] s1", 1);
  s.set("profile", std::string("mag-13-100"), 2);
  s.set("palmacq", palmacq, 3);
  s.set("temperature", std::string("p"), 4);
  s.set("degC_per_V", 100.0, 5);
  s.set("degC_at_0V", -5.0, 6);
  ObsdaqSettings out = read_obsdaq_settings(s);
  EXPECT_TRUE(s.errors().empty());
  return out;
}

class ObsdaqDriverTest : public ::testing::Test {
 protected:
  void go_live() {
    bench.open();
    ASSERT_TRUE(bench.pass_until([&] { return driver.health().state == LinkState::live; }));
    bench.forget_events();
  }
  Instrument instrument;
  ObsdaqDriver driver{2, settings()};
  DeviceBench bench{driver, std::ref(instrument)};
};

TEST_F(ObsdaqDriverTest, StartsAsDocumented) {
  go_live();
  EXPECT_EQ(instrument.commands,
            (std::vector<std::string>{"#01ST", "$01M", "$01SN", "#01PP00000000", "$010WS02010263",
                                      "$011WS02010263", "$012WS02010263", "#01PP0C00026E", "#01CS"}));
  EXPECT_TRUE(bench.sent().starts_with("||||||||||||||||||||||||||||||#01ST\r"));
  EXPECT_EQ(driver.health().identity, "<obsDAQ V5.5.7>, serial 1001");
  EXPECT_TRUE(driver.health().balanced());
}

TEST_F(ObsdaqDriverTest, WaitsASecondAfterTheTriggerIsOff) {
  bench.open();
  ASSERT_TRUE(bench.pass_until([&] { return bench.sent().find("PP00000000\r") != std::string::npos; }));
  const double off_s = bench.t_s();
  ASSERT_TRUE(bench.pass_until([&] { return bench.sent().find("WS02010263\r") != std::string::npos; }));
  EXPECT_GE(bench.t_s() - off_s, 1.0 - 1e-6);
}

TEST_F(ObsdaqDriverTest, TurnsLinesIntoReadings) {
  go_live();
  bench.feed("*0259FEFFF1BFFFFCEDL\r*0259FEFFF1BF");
  bench.feed("FFFCEDL:04AC11CC000B000B000B\r");
  const auto readings = bench.events<FieldReading>();
  ASSERT_EQ(readings.size(), 2U);
  EXPECT_EQ(readings[0].slot, 2);
  EXPECT_EQ(readings[0].seq, 0U);
  EXPECT_EQ(readings[1].seq, 1U);
  EXPECT_NEAR(readings[0].y_nT.x(), 1837.13, 5e-3);  // 0.183713 V at 10000 nT/V
  EXPECT_NEAR(readings[0].y_nT.y(), -43.50, 5e-3);
  EXPECT_NEAR(readings[0].y_nT.z(), -9.38, 5e-3);
  EXPECT_FALSE(readings[0].flags.any());
  const auto temperatures = bench.events<TemperatureReading>();
  ASSERT_EQ(temperatures.size(), 1U);
  EXPECT_NEAR(*temperatures[0].sensor_degC, -4.8625, 1e-9);  // 0.001375 V * 100 - 5
  EXPECT_NEAR(*temperatures[0].electronics_degC, 35.594, 5e-4);
}

TEST_F(ObsdaqDriverTest, LinesInOneChunkAreStampedByTheirPlaceOnTheWire) {
  go_live();
  bench.feed("*0259FEFFF1BFFFFCEDL\r*0259FEFFF1BFFFFCEDL\r");
  const auto readings = bench.events<FieldReading>();
  ASSERT_EQ(readings.size(), 2U);
  EXPECT_EQ(readings[1].arrival.mono, bench.now().mono);
  EXPECT_NEAR(to_seconds(readings[1].arrival.mono - readings[0].arrival.mono), 21 * 10 / 19200.0, 1e-8);
}

TEST_F(ObsdaqDriverTest, FlagsSaturation) {
  go_live();
  bench.feed("*7FFFFF000000000000L\r");
  EXPECT_TRUE(bench.events<FieldReading>().at(0).flags.has(Flag::saturated));
}

TEST_F(ObsdaqDriverTest, ARejectedLineCountsOne) {
  go_live();
  bench.feed("*0259FEFFF1BFFFFCEDL\r*0259FEFF1BFFFFCEDL\r*0259FEFFF1BFFFFCEDL\r");
  const auto readings = bench.events<FieldReading>();
  ASSERT_EQ(readings.size(), 2U);
  EXPECT_EQ(readings[1].seq, 2U);
  EXPECT_EQ(driver.health().rejected[static_cast<std::size_t>(Reject::length)], 1U);
  EXPECT_TRUE(driver.health().balanced());
}

TEST_F(ObsdaqDriverTest, ALineThatLostItsEndingCountsTwo) {
  go_live();
  bench.feed("*0259FEFFF1BFFFFCEDL\r*0259FEFFF1BFFFFCEDL*0259FEFFF1BFFFFCEDL\r*0259FEFFF1BFFFFCEDL\r");
  EXPECT_EQ(bench.events<FieldReading>().back().seq, 3U);
  bench.feed(
      "*0259FE\xFF"
      "F1BFFFFCEDL\r*0259FEFFF1BFFFFCEDL\r");
  EXPECT_EQ(bench.events<FieldReading>().back().seq, 5U) << "a byte no line contains";
}

TEST_F(ObsdaqDriverTest, AnUnsolicitedReplyIsRejectedAndNoLostSample) {
  go_live();
  bench.feed("*0259FEFFF1BFFFFCEDL\r?01\r!01\r*0259FEFFF1BFFFFCEDL\r");
  EXPECT_EQ(bench.events<FieldReading>().back().seq, 1U);
  EXPECT_EQ(driver.health().rejected[static_cast<std::size_t>(Reject::framing)], 2U);
}

TEST_F(ObsdaqDriverTest, ADeviceFoundStreamingIsStoppedFirst) {
  instrument.streaming = true;
  bench.open();
  bench.feed("1BFFFFCEDL\r*0259FEFFF1BFFFFCEDL\r*0259");  // torn first line, and one cut off by the stop
  ASSERT_TRUE(bench.pass_until([&] { return driver.health().state == LinkState::live; }));
  EXPECT_TRUE(bench.events<FieldReading>().empty());
  EXPECT_TRUE(bench.events<DeviceFault>().empty());
  bench.feed("*0259FEFFF1BFFFFCEDL\r");
  EXPECT_EQ(bench.events<FieldReading>().at(0).seq, 0U);
}

TEST_F(ObsdaqDriverTest, TheQuickStopIsRepeatedWhileBytesCome) {
  bench.open();
  for (int i = 0; i < 60; ++i) {  // 2.4 s of a device that does not listen at first
    bench.feed("*0259FEFFF1BFFFFCEDL\r");
    bench.pass(0.04);
  }
  EXPECT_EQ(bench.sent(), std::string(90, '|'));
  ASSERT_TRUE(bench.pass_until([&] { return driver.health().state == LinkState::live; }));
}

TEST_F(ObsdaqDriverTest, ADeviceThatNeverFallsSilentIsAFault) {
  bench.open();
  ASSERT_TRUE(bench.pass_until([&] {
    bench.feed("12345.67\r");
    return driver.health().state == LinkState::failed;
  }));
  EXPECT_THAT(bench.events<DeviceFault>().at(0).what, HasSubstr("bytes keep coming"));
}

TEST_F(ObsdaqDriverTest, AnotherDeviceOnThePortIsNamed) {
  instrument.identity = "!017013";
  bench.open();
  ASSERT_TRUE(bench.pass_until([&] { return driver.health().state == LinkState::failed; }));
  EXPECT_THAT(bench.events<DeviceFault>().at(0).what, HasSubstr("'7013', not an ObsDAQ"));
  EXPECT_THAT(driver.health().detail, HasSubstr("check which device"));
  instrument.identity = "!01<obsDAQ V5.5.7>";  // the operator exchanges the plugs
  ASSERT_TRUE(bench.pass_until([&] { return driver.health().state == LinkState::live; }));
  EXPECT_EQ(bench.events<DeviceFault>().size(), 1U);
}

TEST_F(ObsdaqDriverTest, AFirmwareThatKnowsNoSerialNumberIsUsedWithoutDelay) {
  instrument.serial.clear();
  const double before_s = bench.t_s();
  go_live();
  EXPECT_LT(bench.t_s() - before_s, 3);
  EXPECT_EQ(driver.health().identity, "<obsDAQ V5.5.7>");
}

TEST_F(ObsdaqDriverTest, AnotherOneOfTheSameMakeIsRefusedUntilThePlugsAreExchanged) {
  ObsdaqSettings stated = settings();
  stated.serial = "1001";
  instrument.serial = "1002";
  ObsdaqDriver device(0, stated);
  DeviceBench stage(device, std::ref(instrument));
  stage.open();
  ASSERT_TRUE(stage.pass_until([&] { return device.health().state == LinkState::failed; }));
  EXPECT_THAT(device.health().detail,
              HasSubstr("wrong device on the port: its serial number is 1002, not 1001"));
  EXPECT_THAT(device.health().detail, HasSubstr("exchange the plugs"));
  EXPECT_FALSE(instrument.streaming);
  instrument.serial = "1001";
  ASSERT_TRUE(stage.pass_until([&] { return device.health().state == LinkState::live; }));
  EXPECT_EQ(stage.events<DeviceFault>().size(), 1U);
}

TEST_F(ObsdaqDriverTest, WhereASerialNumberIsStatedOneMustBeTold) {
  ObsdaqSettings stated = settings();
  stated.serial = "1001";
  instrument.serial.clear();
  ObsdaqDriver device(0, stated);
  DeviceBench stage(device, std::ref(instrument));
  stage.open();
  ASSERT_TRUE(stage.pass_until([&] { return device.health().state == LinkState::failed; }));
  EXPECT_THAT(device.health().detail, HasSubstr("'$01SN' was answered by '?01'"));
}

TEST_F(ObsdaqDriverTest, EveryRefusedOrMissingEchoIsNoticed) {
  for (const std::string command : {"#01PP00000000", "$010WS", "$011WS", "$012WS", "#01PP0C00", "#01CS"}) {
    for (const bool refused : {true, false}) {
      Instrument stubborn;
      (refused ? stubborn.spoil : stubborn.mute) = command;
      ObsdaqDriver device(0, settings());
      DeviceBench stage(device, std::ref(stubborn));
      stage.open();
      const LinkState expected = refused ? LinkState::failed : LinkState::silent;
      ASSERT_TRUE(stage.pass_until([&] { return device.health().state == expected; })) << command;
      EXPECT_THAT(device.health().detail, HasSubstr(command)) << "the message names what was asked";
      EXPECT_EQ(stage.events<DeviceFault>().empty(), !refused);
    }
  }
}

TEST_F(ObsdaqDriverTest, AReplyLostOnceIsAskedForAgain) {
  int asked = 0;
  DeviceBench stage(driver, [&](std::string_view sent) {
    const std::string reply = instrument(sent);
    return sent.starts_with("$01M") && ++asked == 1 ? std::string() : reply;
  });
  stage.open();
  ASSERT_TRUE(stage.pass_until([&] { return driver.health().state == LinkState::live; }));
  EXPECT_EQ(asked, 2);
}

TEST_F(ObsdaqDriverTest, ADeadPortIsSilentAndThenReopened) {
  DeviceBench stage(driver);
  stage.open();
  ASSERT_TRUE(stage.pass_until([&] { return driver.health().state == LinkState::silent; }));
  EXPECT_THAT(driver.health().detail, HasSubstr("19200 Bd; check power, cable, baud and address 01"));
  ASSERT_TRUE(stage.pass_until([&] { return driver.wants_reopen(); }));
  stage.close();
  EXPECT_FALSE(driver.wants_reopen());
}

TEST_F(ObsdaqDriverTest, AStreamThatStopsIsStartedAgain) {
  go_live();
  bench.feed("*0259FEFFF1BFFFFCEDL\r");
  bench.forget_sent();
  ASSERT_TRUE(bench.pass_until([&] { return driver.health().state == LinkState::silent; }));
  EXPECT_THAT(driver.health().detail, HasSubstr("nothing came for 1.0 s"));
  ASSERT_TRUE(bench.pass_until([&] { return driver.health().state == LinkState::live; }));
  EXPECT_THAT(bench.sent(), HasSubstr("$012WS02010263")) << "its range may be gone";
  EXPECT_THAT(bench.sent(), HasSubstr("#01CS\r"));
  bench.feed("*0259FEFFF1BFFFFCEDL\r");
  EXPECT_EQ(bench.events<FieldReading>().back().seq, 0U) << "a new acquisition counts anew";
}

/// It was switched off and on, or somebody else spoke with it: what the configuration says counts.
TEST_F(ObsdaqDriverTest, ADigitiserAtAnotherRateIsToldItsSettingsAgain) {
  go_live();
  bench.forget_sent();
  const auto send_every = [&](int ticks, double seconds) {
    for (int i = 0; i < static_cast<int>(seconds * 50); ++i) {
      bench.tick();
      if (i % ticks == 0) bench.feed("*0259FEFFF1BFFFFCEDL\r");
      if (driver.health().state != LinkState::live) return;
    }
  };
  send_every(1, 60);
  EXPECT_EQ(driver.health().state, LinkState::live);
  send_every(2, 25);
  EXPECT_EQ(driver.health().state, LinkState::silent);
  EXPECT_THAT(driver.health().detail, HasSubstr("readings a second instead of 50"));
  ASSERT_TRUE(bench.pass_until([&] { return driver.health().state == LinkState::live; }));
  EXPECT_THAT(bench.sent(), HasSubstr("$010WS02010263"));
  EXPECT_THAT(bench.sent(), HasSubstr("#01PP0C00026E"));
  EXPECT_TRUE(driver.health().balanced());
}

TEST_F(ObsdaqDriverTest, GarbageIsNoSign0fLife) {
  go_live();
  ASSERT_TRUE(bench.pass_until([&] {
    bench.feed("\xF0garbage\r");
    return driver.health().state == LinkState::silent;
  }));
  EXPECT_THAT(driver.health().detail, HasSubstr("no valid line"));
  EXPECT_TRUE(bench.events<FieldReading>().empty());
  EXPECT_TRUE(driver.health().balanced());
}

TEST_F(ObsdaqDriverTest, AHostThatWasStoppedDoesNotBlameTheDevice) {
  go_live();
  bench.feed("*0259FEFFF1BFFFFCEDL\r");
  driver.on_tick({bench.now().mono + std::chrono::seconds(60), {}});  // one late tick, before any read
  EXPECT_EQ(driver.health().state, LinkState::live);
}

TEST_F(ObsdaqDriverTest, StopsTheStreamWhenTheProgramEnds) {
  go_live();
  bench.forget_sent();
  driver.on_shutdown(bench.now());
  bench.exchange();
  EXPECT_EQ(bench.sent(), "#01ST\r");
}

TEST_F(ObsdaqDriverTest, ReplugStartsOver) {
  go_live();
  bench.feed("*0259FEF");
  bench.close();
  EXPECT_TRUE(driver.health().balanced());
  bench.pass(5);
  bench.forget_sent();
  go_live();
  EXPECT_THAT(bench.sent(), HasSubstr("#01CS\r"));
  EXPECT_EQ(driver.health().opens, 2U);
}

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

TEST(ObsdaqRegistry, KnowsTheDriver) {
  const DriverEntry* entry = find_driver("obsdaq");
  ASSERT_NE(entry, nullptr);
  EXPECT_EQ(entry->role, Role::sensor);
  Settings s("[[sensor]] s1", 1);
  s.set("profile", std::string("mag-03-70"), 2);
  EXPECT_NE(entry->make(0, s), nullptr);
  s.refuse_unknown();
  EXPECT_TRUE(s.errors().empty());
}

}  // namespace
}  // namespace mgtd::drivers::obsdaq
