// SPDX-License-Identifier: Apache-2.0
#include "drivers/gsm_driver.h"

#include <gmock/gmock.h>

#include "drivers/registry.h"
#include "tests/support/device_bench.h"

namespace mgtd::drivers::gsm {
namespace {

using mgtd::testing::DeviceBench;
using ::testing::HasSubstr;

TEST(GsmDriver, ReadsLinesWithTheirQuality) {
  GsmDriver driver{GsmSettings{}};
  DeviceBench bench(driver);
  bench.open();
  EXPECT_EQ(bench.sent(), "") << "it only listens";
  bench.feed("4.12 99\r\n/Gem Systems GSM-19GWV 7022463\r\n115014.0  48484.12 99\r\n115015.0  484");
  bench.feed("84.15 59\r\n115016.0  48484.20\r\n");
  const auto readings = bench.events<ScalarReading>();
  ASSERT_EQ(readings.size(), 3U);
  EXPECT_EQ(readings[0].f_nT, 48484.12);
  EXPECT_TRUE(readings[0].good);
  EXPECT_EQ(readings[1].quality, 59);
  EXPECT_FALSE(readings[1].good) << "flagged, number kept";
  EXPECT_EQ(readings[2].quality, -1);
  EXPECT_TRUE(readings[2].good);
  EXPECT_EQ(driver.health().state, LinkState::live);
  EXPECT_THAT(driver.health().identity, HasSubstr("GSM-19GWV"));
  EXPECT_TRUE(driver.health().balanced());
}

TEST(GsmDriver, AnotherInstrumentThanTheStatedOneIsRefused) {
  GsmSettings settings;
  settings.serial = "3101329";
  GsmDriver driver{settings};
  DeviceBench bench(driver);
  bench.open();
  bench.feed("115013.0  48484.12 99\r\n");
  EXPECT_EQ(bench.events<ScalarReading>().size(), 1U) << "no header yet: believed";
  bench.feed("/Gem Systems GSM-19W 7022463 v6.0\r\n115014.0  48484.12 99\r\n");
  EXPECT_EQ(bench.events<ScalarReading>().size(), 1U);
  EXPECT_EQ(driver.health().state, LinkState::failed);
  EXPECT_THAT(driver.health().detail, HasSubstr("its serial number is 7022463, not 3101329"));
  EXPECT_EQ(bench.events<DeviceFault>().size(), 1U);
  bench.feed("/Gem Systems GSM-19W 3101329 v6.0\r\n115015.0  48484.12 99\r\n");
  EXPECT_EQ(driver.health().state, LinkState::live);
  EXPECT_EQ(bench.events<ScalarReading>().size(), 2U);
}

TEST(GsmDriver, AFieldThatCannotBeIsRejected) {
  GsmDriver driver{GsmSettings{}};
  DeviceBench bench(driver);
  bench.open();
  bench.feed("115014.0   1234.56 99\r\n115014.0 122484.12 99\r\n");
  EXPECT_TRUE(bench.events<ScalarReading>().empty());
  EXPECT_EQ(driver.health().rejected[static_cast<std::size_t>(Reject::range)], 2U);
  EXPECT_EQ(driver.health().state, LinkState::probing);
}

TEST(GsmDriver, SetUpStringsGoOutOneByOne) {
  GsmSettings settings;
  settings.init = {"S", "T048.5", "{utc}", "R"};
  GsmDriver driver(settings);
  std::vector<std::string> sent;
  std::vector<double> at_s;
  DeviceBench* clock = nullptr;
  DeviceBench bench(driver, [&](std::string_view bytes) -> std::string {
    sent.emplace_back(bytes);
    at_s.push_back(clock->t_s());
    return bytes == "T048.5" ? "menu: z-save\r\n" : "";
  });
  clock = &bench;
  bench.open();
  bench.pass(10);
  ASSERT_EQ(sent.size(), 5U);
  EXPECT_EQ(sent[0], "S");
  EXPECT_EQ(sent[1], "T048.5");
  EXPECT_EQ(sent[2], "z");
  EXPECT_EQ(sent[3].size(), 13U);
  EXPECT_EQ(sent[4], "R");
  EXPECT_GE(at_s[1] - at_s[0], 1.0);
  EXPECT_GE(at_s[4] - at_s[3], 1.0);
}

TEST(GsmDriver, SilenceSaysWhatWasHeardLast) {
  GsmDriver driver{GsmSettings{}};
  DeviceBench bench(driver);
  bench.open();
  bench.feed("Memory full\r\n");
  ASSERT_TRUE(bench.pass_until([&] { return driver.health().state == LinkState::silent; }));
  EXPECT_THAT(driver.health().detail, HasSubstr("last heard 'Memory full'; check power"));
  EXPECT_EQ(bench.events<DeviceNote>().size(), 1U);
  bench.feed("115014.0  48484.12 99\r\n");
  EXPECT_EQ(driver.health().state, LinkState::live);
  ASSERT_TRUE(bench.pass_until([&] { return driver.wants_reopen(); }, 100));
}

TEST(GsmSettingsTest, MistakesAreNamed) {
  Settings s("[scalar]", 1);
  s.set("baud", std::int64_t{1}, 2);
  s.set("init", std::string("S"), 3);
  s.set("range_nT", std::vector<double>{5, 1}, 4);
  s.set("silence_s", 0.1, 5);
  static_cast<void>(read_gsm_settings(s));
  EXPECT_EQ(s.errors().size(), 4U);
}

TEST(GsmRegistry, IsAScalarReference) {
  const DriverEntry* entry = find_driver("gsm");
  ASSERT_NE(entry, nullptr);
  EXPECT_EQ(entry->role, Role::scalar);
  Settings s("[scalar]", 1);
  EXPECT_EQ(entry->make(0, s)->baud(), 115200);
}

TEST(GsmDriver, SomethingElseThatTalksOnIsTheWrongDevice) {
  GsmDriver driver(GsmSettings{});
  DeviceBench bench(driver);
  bench.open();
  ASSERT_TRUE(bench.pass_until([&] {
    bench.feed("$GPGGA,100000.00,4717.11,N\r\n");
    return driver.health().state == LinkState::failed;
  }));
  EXPECT_THAT(driver.health().detail, HasSubstr("'$GPGGA,100000.00,4717.11,N'; wrong device on the port?"));
  bench.feed("115014.0  48484.12 99\r\n");
  EXPECT_EQ(driver.health().state, LinkState::live);
}

}  // namespace
}  // namespace mgtd::drivers::gsm
