// SPDX-License-Identifier: Apache-2.0
#include "drivers/obsdaq_protocol.h"

#include <gtest/gtest.h>

namespace mgtd::drivers::obsdaq {
namespace {

// Captured from a PalmAcq (MARTAS, martas/app/palmacq.py).
constexpr std::string_view kCaptured = ":R,00,200131.143739.617,*0259FEFFF1BFFFFCEDL:04AC11CC000B000B000B";

TEST(ObsdaqProtocol, DecodesACapturedLine) {
  const auto sample = parse_data_line(kCaptured);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->counts, (std::array<std::int32_t, 3>{154110, -3649, -787}));
  EXPECT_NEAR(volts(sample->counts[0], 10), 0.183713, 5e-7);  // as printed: six decimals
  EXPECT_NEAR(volts(sample->counts[1], 10), -0.004350, 5e-7);
  EXPECT_NEAR(volts(sample->counts[2], 10), -0.000938, 5e-7);
  EXPECT_EQ(sample->trigger, 'L');
  ASSERT_TRUE(sample->supplement);
  EXPECT_NEAR(sample->supplement->supply_V, 12.334, 5e-4);
  EXPECT_NEAR(sample->supplement->electronics_degC, 35.594, 5e-4);
  for (const double aux_V : sample->supplement->aux_V) EXPECT_DOUBLE_EQ(aux_V, 0.001375);
  ASSERT_TRUE(sample->device_time_s);
  EXPECT_DOUBLE_EQ(*sample->device_time_s,
                   7335 * 86400.0 + 14 * 3600 + 37 * 60 + 39.617);  // day 7335: 2020-01-31
}

TEST(ObsdaqProtocol, DecodesADirectLine) {
  const auto sample = parse_data_line("*0259FEFFF1BFFFFCEDL");
  ASSERT_TRUE(sample);
  EXPECT_FALSE(sample->time_stamped);
  EXPECT_FALSE(sample->device_time_s);
  EXPECT_FALSE(sample->supplement);
  EXPECT_FALSE(sample->saturated());
}

TEST(ObsdaqProtocol, TemperaturesBelowZeroAreSigned) {
  const auto sample = parse_data_line("*000000000000000000L:04ACFE80E0C0FFFF8000");
  ASSERT_TRUE(sample && sample->supplement);
  EXPECT_DOUBLE_EQ(sample->supplement->electronics_degC, -3.0);
  EXPECT_DOUBLE_EQ(sample->supplement->aux_V[0], -1.0);
  EXPECT_DOUBLE_EQ(sample->supplement->aux_V[1], -1.0 / 8000);
  EXPECT_DOUBLE_EQ(sample->supplement->aux_V[2], -4.096);
}

TEST(ObsdaqProtocol, EndsOfTheRangeAreSaturated) {
  EXPECT_TRUE(parse_data_line("*7FFFFF000000000000L")->saturated());
  EXPECT_TRUE(parse_data_line("*000000800000000000L")->saturated());
  EXPECT_FALSE(parse_data_line("*7F0000000000810000L")->saturated());
}

TEST(ObsdaqProtocol, RefusesEveryDamageWithItsReason) {
  const auto why = [](std::string_view line) { return parse_data_line(line).error(); };
  EXPECT_EQ(why(""), Reject::framing);
  EXPECT_EQ(why("0259FEFFF1BFFFFCEDL"), Reject::framing);   // first byte lost
  EXPECT_EQ(why("*0259FEFF1BFFFFCEDL"), Reject::length);    // a byte lost
  EXPECT_EQ(why("*0259FEFFF1BFFFFCED0"), Reject::framing);  // no trigger letter
  EXPECT_EQ(why("*0259FEFFG1BFFFFCEDL"), Reject::number);   // not hex
  EXPECT_EQ(why("*0259feFFF1BFFFFCEDL"), Reject::number);   // the device sends capitals
  EXPECT_EQ(why("*0259FEFFF1BFFFFCEDL;04AC11CC000B000B000B"), Reject::framing);
  EXPECT_EQ(why("*0259FEFFF1BFFFFCEDL:04AC11CC000B000B00ZB"), Reject::number);
  EXPECT_EQ(why(":R,00,200131.143739.6"), Reject::framing);
  EXPECT_EQ(why(":R,00,200131.1437x9.617,*0259FEFFF1BFFFFCEDL"), Reject::number);
  EXPECT_EQ(why(":R,0x,200131.143739.617,*0259FEFFF1BFFFFCEDL"), Reject::number);
}

TEST(ObsdaqProtocol, EveryByteOfALineMatters) {
  for (std::size_t i = 0; i < kCaptured.size(); ++i) {
    std::string torn(kCaptured);
    torn.erase(i, 1);
    EXPECT_FALSE(parse_data_line(torn)) << torn;
  }
}

TEST(ObsdaqProtocol, ADateThatDoesNotExistGivesNoDeviceTime) {
  for (const std::string_view stamp :
       {"200132.143739.617", "200001.143739.617", "201301.143739.617", "200230.000000.000",
        "200131.240000.000", "200131.236000.000", "200131.235960.000"}) {
    const auto sample = parse_data_line(":R,00," + std::string(stamp) + ",*0259FEFFF1BFFFFCEDL");
    ASSERT_TRUE(sample) << stamp;
    EXPECT_TRUE(sample->time_stamped);
    EXPECT_FALSE(sample->device_time_s) << stamp;
  }
}

TEST(ObsdaqProtocol, CommandsAreThoseOfTheCapturedDialogues) {
  EXPECT_EQ(trigger("01", 0x1000, 0x0500).command, "#01PP10000500\r");
  EXPECT_EQ(trigger("01", 0x1000, 0x0500).reply, "!0110000500");
  EXPECT_EQ(configure("01", 0, "02", "33").command, "$010WS02010233\r");
  EXPECT_EQ(configure("01", 0, "02", "33").reply, "!0102010233");
  EXPECT_EQ(start("01").command, "#01CS\r");
  EXPECT_EQ(start("01").reply, "!01");
}

// The maker's table gives dd, and a high time (eeee - ffff) of 2450, 2050, 1250, 290, 290, 290 units.
TEST(ObsdaqProtocol, TimingIsThatOfTheMakersTable) {
  struct Row {
    double rate_hz;
    std::uint16_t period;
    std::string_view code;
    int high;
  };
  for (const Row& row :
       {Row{50, 0x0C00, "63", 2450}, Row{60, 0x0A00, "72", 2050}, Row{100, 0x0600, "82", 1250},
        Row{128, 0x04B0, "92", 290}, Row{150, 0x0400, "92", 290}, Row{200, 0x0300, "92", 290}}) {
    const auto timing = timing_for(row.rate_hz);
    ASSERT_TRUE(timing);
    EXPECT_EQ(timing->period, row.period);
    EXPECT_EQ(timing->rate_code, row.code);
    EXPECT_EQ(timing->period - timing->low, row.high);
  }
  EXPECT_EQ(timing_for(10)->period, 0x3C00);
  EXPECT_FALSE(timing_for(2));
  EXPECT_FALSE(timing_for(0));
  EXPECT_FALSE(timing_for(-5));
  EXPECT_FALSE(timing_for(1000));
}

TEST(ObsdaqProtocol, EveryTimingObeysTheRules) {
  for (double rate_hz = 2.4; rate_hz < 450; rate_hz *= 1.03) {
    const auto timing = timing_for(rate_hz);
    ASSERT_TRUE(timing) << rate_hz;
    const double high_s = (timing->period - timing->low) / kTicksPerSecond;
    EXPECT_GE(high_s, 0.19e-3);
    EXPECT_GE(timing->low / kTicksPerSecond, 1.1e-3);
    EXPECT_NEAR(timing->rate_hz(), rate_hz, rate_hz * rate_hz / kTicksPerSecond);  // one count of the period
  }
}

TEST(ObsdaqProtocol, WhatALineCarries) {
  EXPECT_NEAR(highest_rate_hz(19200, 21), 90.4, 0.05);  // (1920 - 21) bytes/s over 21
}

}  // namespace
}  // namespace mgtd::drivers::obsdaq
