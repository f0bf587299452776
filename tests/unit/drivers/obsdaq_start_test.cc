// SPDX-License-Identifier: Apache-2.0
// How a digitiser is found, stopped, told its settings and started; who is refused.

#include <deque>

#include "tests/unit/drivers/obsdaq_bench.h"

namespace mgtd::drivers::obsdaq {
namespace {

TEST_F(ObsdaqDriverTest, StartsAsDocumented) {
  go_live();
  EXPECT_EQ(instrument.commands,
            (std::vector<std::string>{"#01ST", "$01M", "$01SN", "$01SN", "#01PP00000000", "$010WS02010263",
                                      "$011WS02010263", "$012WS02010263", "#01PP0C00026E", "#01CS"}));
  EXPECT_TRUE(bench.sent().starts_with("||||||||||||||||||||||||||||||#01ST\r"));
  EXPECT_EQ(driver.health().identity, "<obsDAQ V5.5.7>, serial 1001");
  EXPECT_TRUE(driver.health().balanced());
}

TEST_F(ObsdaqDriverTest, ASerialNumberThatWasDamagedOnTheLineIsNotBelieved) {
  instrument.damaged_serials = 1;
  go_live();
  EXPECT_EQ(driver.health().identity, "<obsDAQ V5.5.7>, serial 1001");
  EXPECT_EQ(std::count(instrument.commands.begin(), instrument.commands.end(), "$01M"), 2);
}

TEST_F(ObsdaqDriverTest, WaitsASecondAfterTheTriggerIsOff) {
  bench.open();
  ASSERT_TRUE(bench.pass_until([&] { return bench.sent().find("PP00000000\r") != std::string::npos; }));
  const double off_s = bench.t_s();
  ASSERT_TRUE(bench.pass_until([&] { return bench.sent().find("WS02010263\r") != std::string::npos; }));
  EXPECT_GE(bench.t_s() - off_s, 1.0 - 1e-6);
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
  EXPECT_THAT(bench.events<DeviceFault>().at(0).what,
              HasSubstr("wrong device on the port: it calls itself '7013', not an ObsDAQ"));
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

/// Whatever is late by up to two seconds: echoes of one channel are those of another to the letter.
TEST_F(ObsdaqDriverTest, LateRepliesAreNotTakenForThoseOfTheNextQuestion) {
  for (const double late_s : {0.3, 0.45, 0.9, 1.7}) {
    SCOPED_TRACE(late_s);
    Instrument slow;
    ObsdaqSettings stated = settings();
    stated.serial = "1001";
    ObsdaqDriver device(0, stated);
    std::deque<std::pair<double, std::string>> wire;
    DeviceBench* stage = nullptr;
    DeviceBench late(device, [&](std::string_view sent) {
      for (std::size_t at = 0; at < sent.size();) {  // one command after the other
        const std::size_t end = std::min(sent.find('\r', at), sent.size() - 1);
        const std::string reply = slow(sent.substr(at, end + 1 - at));
        if (!reply.empty()) wire.emplace_back(stage->t_s() + late_s, reply);
        at = end + 1;
      }
      return std::string();
    });
    stage = &late;
    late.open();
    ASSERT_TRUE(late.pass_until(
        [&] {
          for (; !wire.empty() && wire.front().first <= late.t_s(); wire.pop_front())
            late.feed(wire.front().second);
          return device.health().state == LinkState::live;
        },
        200));
    EXPECT_TRUE(late.events<DeviceFault>().empty());
    EXPECT_EQ(device.health().identity, "<obsDAQ V5.5.7>, serial 1001");
  }
}

}  // namespace
}  // namespace mgtd::drivers::obsdaq
