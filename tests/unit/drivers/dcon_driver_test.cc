// SPDX-License-Identifier: Apache-2.0
#include "drivers/dcon_driver.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "drivers/registry.h"
#include "tests/support/device_bench.h"

namespace mgtd::drivers::dcon {
namespace {

using mgtd::testing::DeviceBench;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::SizeIs;

DconSettings three_channels() {
  DconSettings out;
  out.inputs = 3;
  out.channels = {{0, "0", "channels", "motor_A", "A", 0.1, 0.5},
                  {2, "2", "channels", "s3_T_degC", "degC", 1, 0}};
  return out;
}

std::string module(std::string_view sent) {
  return sent == "$01M\r" ? "!017033\r" : sent == "#01\r" ? ">+025.00+001.00+021.50\r" : "";
}

TEST(DconDriver, AsksForItsChannelsAndNamesThem) {
  DconDriver driver(three_channels());
  DeviceBench bench(driver, &module);
  bench.open();
  bench.pass(3.1);
  EXPECT_EQ(driver.health().state, LinkState::live);
  EXPECT_EQ(driver.health().identity, "7033");
  const auto readings = bench.events<AuxiliaryReading>();
  ASSERT_THAT(readings, SizeIs(4)) << "at once, and every second";
  EXPECT_THAT(readings[0].values, ElementsAre(Pair("motor_A", 3.0)));
  const auto temperatures = bench.events<TemperatureReading>();
  ASSERT_THAT(temperatures, SizeIs(4));
  EXPECT_EQ(temperatures[0].slot, 2);
  EXPECT_EQ(temperatures[0].sensor_degC, 21.5);
  EXPECT_TRUE(driver.health().balanced());
}

TEST(DconDriver, AChannelThatTheModuleDoesNotSendIsNotRead) {
  DconSettings settings = three_channels();
  settings.inputs = 0;
  DconDriver driver(settings);
  DeviceBench bench(driver, [](std::string_view sent) -> std::string {
    return sent == "#01\r" ? ">+025.00+001.00\r" : "";
  });
  bench.open();
  bench.pass(2);
  EXPECT_EQ(driver.health().state, LinkState::failed);
  EXPECT_THAT(driver.health().detail, HasSubstr("sends 2 channels, 3 are configured"));
}

TEST(DconDriver, AChannelOutOfRangeIsLeftOut) {
  DconDriver driver(three_channels());
  DeviceBench bench(driver, [](std::string_view sent) -> std::string {
    return sent == "#01\r" ? ">+9999+001.00-0000\r" : "";
  });
  bench.open();
  bench.pass(2);
  EXPECT_EQ(driver.health().state, LinkState::live);
  EXPECT_THAT(bench.events<AuxiliaryReading>(), IsEmpty());
  EXPECT_THAT(bench.events<TemperatureReading>(), IsEmpty());
}

TEST(DconDriver, SilenceIsNoticedAndTheModuleAskedOn) {
  bool answers = true;
  DconDriver driver(three_channels());
  DeviceBench bench(driver, [&](std::string_view sent) { return answers ? module(sent) : std::string(); });
  bench.open();
  bench.pass(2);
  answers = false;
  ASSERT_TRUE(bench.pass_until([&] { return driver.health().state == LinkState::silent; }, 10));
  EXPECT_THAT(driver.health().detail, HasSubstr("address (01)"));
  answers = true;
  EXPECT_TRUE(bench.pass_until([&] { return driver.health().state == LinkState::live; }, 3));
  answers = false;
  EXPECT_TRUE(bench.pass_until([&] { return driver.wants_reopen(); }, 60));
}

TEST(DconDriver, FewerChannelsThanConfiguredIsAFailureThatSaysSo) {
  DconDriver driver(three_channels());
  DeviceBench bench(driver,
                    [](std::string_view sent) -> std::string { return sent == "#01\r" ? ">+025.00\r" : ""; });
  bench.open();
  bench.pass(2);
  EXPECT_EQ(driver.health().state, LinkState::failed);
  EXPECT_THAT(driver.health().detail, HasSubstr("1 channels, 3 are configured"));
  EXPECT_THAT(bench.events<AuxiliaryReading>(), IsEmpty());
}

/// The values of one second, told in the next, would stand beside other samples than their own.
TEST(DconDriver, AnAnswerThatComesAfterAllPatienceIsNotTakenForTheNext) {
  DconDriver driver(three_channels());
  double deaf_until_s = 0, value = 25;
  DeviceBench* wire = nullptr;
  DeviceBench bench(driver, [&](std::string_view sent) -> std::string {
    if (wire->t_s() < deaf_until_s) return "";
    return sent == "#01\r" ? fmt::format(">{:+07.2f}+001.00+021.50\r", value) : module(sent);
  });
  wire = &bench;
  bench.open();
  bench.pass(2.1);
  ASSERT_EQ(driver.health().state, LinkState::live);
  deaf_until_s = bench.t_s() + 5.5;
  bench.pass(5);
  bench.forget_events();
  bench.forget_sent();
  value = 99;
  bench.feed(">+025.00+001.00+021.50\r");
  EXPECT_THAT(bench.events<AuxiliaryReading>(), IsEmpty()) << "nobody can tell which question it answers";
  bench.pass(5);
  EXPECT_EQ(bench.sent().find("$01M\r"), 0U) << "proved by its name";
  ASSERT_FALSE(bench.events<AuxiliaryReading>().empty());
  for (const auto& reading : bench.events<AuxiliaryReading>())
    EXPECT_NEAR(reading.values.at(0).second, 0.1 * 99 + 0.5, 1e-9);
}

TEST(DconDriver, WhatTalksAndIsNoModuleIsTheWrongDevice) {
  DconDriver driver(three_channels());
  DeviceBench bench(driver);
  bench.open();
  ASSERT_TRUE(bench.pass_until([&] {
    bench.feed("$GPGGA,100000.00,4717.11,N\r");
    return driver.health().state == LinkState::failed;
  }));
  EXPECT_THAT(driver.health().detail, HasSubstr("wrong device on the port?"));
}

TEST(DconSettingsTest, MistakesAreNamed) {
  Settings s("[[auxiliary]]", 1);
  s.set("baud", std::int64_t{1}, 2);
  s.set("address", std::string("1"), 3);
  s.set("every_s", 0.0, 4);
  s.set("channels", std::vector<std::string>{"motor A", "x", "y"}, 5);
  s.set("scale", std::vector<double>{1, 2}, 6);
  s.set("units", std::vector<std::string>{"A"}, 7);
  static_cast<void>(read_dcon_settings(s));
  EXPECT_EQ(s.errors().size(), 6U);
}

TEST(DconSettingsTest, AUnitIsStatedOrToldByTheName) {
  Settings s("[[auxiliary]]", 1);
  s.set("channels", std::vector<std::string>{"motor_A", "", "wind", "s3_T_degC"}, 2);
  const DconSettings told = read_dcon_settings(s);
  ASSERT_THAT(told.channels, SizeIs(3));
  EXPECT_EQ(told.channels[0].unit, "A");
  EXPECT_EQ(told.channels[1].unit, "");
  EXPECT_EQ(told.channels[2].unit, "degC");
  EXPECT_EQ(told.channels[2].index, 3U);
  s.set("units", std::vector<std::string>{"A", "", "m/s", "K"}, 3);
  const DconSettings stated = read_dcon_settings(s);
  EXPECT_EQ(stated.channels[1].unit, "m/s");
  ASSERT_THAT(s.errors(), SizeIs(1));
  EXPECT_THAT(s.errors()[0].message, HasSubstr("the end of 's3_T_degC' says degC, the unit is K"));
}

TEST(DconRegistry, IsAnAuxiliaryModule) {
  const DriverEntry* entry = find_driver("dcon");
  ASSERT_NE(entry, nullptr);
  EXPECT_EQ(entry->role, Role::auxiliary);
}

}  // namespace
}  // namespace mgtd::drivers::dcon
