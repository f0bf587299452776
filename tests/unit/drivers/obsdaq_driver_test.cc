// SPDX-License-Identifier: Apache-2.0
#include "drivers/obsdaq_driver.h"

#include "drivers/registry.h"
#include "tests/unit/drivers/obsdaq_bench.h"

namespace mgtd::drivers::obsdaq {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::SizeIs;

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
  ASSERT_EQ(temperatures.size(), 3U);
  EXPECT_NEAR(*temperatures[0].electronics_degC, 35.594, 5e-4);
  EXPECT_EQ(temperatures[1].slot, 2);
  EXPECT_NEAR(*temperatures[1].sensor_degC, -4.8625, 1e-9);  // 0.001375 V * 100 - 5
}

/// Input p is its own thermometer, q a motor's current at 2 A/V, r the thermometer of another sensor.
TEST_F(ObsdaqDriverTest, ItsInputsAreColumnsAndThermometers) {
  go_live();
  bench.feed("*0259FEFFF1BFFFFCEDL:04AC11CC000B1F40E0C0\r");
  const auto auxiliary = bench.events<AuxiliaryReading>();
  ASSERT_EQ(auxiliary.size(), 1U);
  EXPECT_THAT(auxiliary[0].values, ElementsAre(Pair("motor_A", DoubleEq(2.5))));  // 1 V * 2 + 0.5
  const auto temperatures = bench.events<TemperatureReading>();
  ASSERT_EQ(temperatures.size(), 3U);
  EXPECT_EQ(temperatures[2].slot, 0);
  EXPECT_NEAR(*temperatures[2].sensor_degC, -10, 1e-9);  // -1 V * 10
  EXPECT_FALSE(temperatures[2].electronics_degC);
}

TEST_F(ObsdaqDriverTest, AnInputAtItsEndIsNotMeasured) {
  go_live();
  bench.feed("*0259FEFFF1BFFFFCEDL:04AC11CC7FFF7FFF8000\r");
  EXPECT_THAT(bench.events<AuxiliaryReading>(), IsEmpty());
  const auto temperatures = bench.events<TemperatureReading>();
  ASSERT_EQ(temperatures.size(), 1U);
  EXPECT_FALSE(temperatures[0].sensor_degC);
  bench.feed("*0259FEFFF1BFFFFCEDL:04AC11CC7FFF7FFE8001\r");
  EXPECT_THAT(bench.events<AuxiliaryReading>(), SizeIs(1));
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
