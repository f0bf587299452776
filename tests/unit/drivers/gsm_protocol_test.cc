// SPDX-License-Identifier: Apache-2.0
#include "drivers/gsm_protocol.h"

#include <gtest/gtest.h>

namespace mgtd::drivers::gsm {
namespace {

GsmReading reading(std::string_view line) {
  const GsmLine parsed = parse_line(line);
  const auto* found = std::get_if<GsmReading>(&parsed);
  EXPECT_NE(found, nullptr) << line;
  return found == nullptr ? GsmReading{} : *found;
}

TEST(GsmProtocol, EveryFormOfALine) {
  const GsmReading v6 = reading("04-22-2015 142244  48464.53 99");
  EXPECT_EQ(v6.f_nT, 48464.53);
  EXPECT_EQ(v6.quality, 99);
  const GsmReading v7 = reading("115014.0  48484.12 99");
  EXPECT_EQ(v7.f_nT, 48484.12);
  EXPECT_EQ(v7.quality, 99);
  const GsmReading gradient = reading("115014.0  48484.12  -0.53");
  EXPECT_EQ(gradient.f_nT, 48484.12);
  EXPECT_EQ(gradient.gradient_nT_per_m, -0.53);
  EXPECT_FALSE(gradient.quality);
  const GsmReading old = reading("410356.0  48484.12");
  EXPECT_EQ(old.f_nT, 48484.12);
  EXPECT_FALSE(old.quality);
  EXPECT_EQ(reading("48484.12").f_nT, 48484.12);
  EXPECT_EQ(reading("48484.12 59").quality, 59);
  EXPECT_EQ(reading("  5014.0\t48484.12 00 ").quality, 0) << "00:50:14";
}

TEST(GsmProtocol, HeadersAndMenusAreText) {
  for (const std::string_view line : {"/Gem Systems GSM-19GWV 7022463 v7.0 7 VI 2012", "/datum  48500.00",
                                      "/time nT sq", "", "   ", "S-setup  R-run z-save", "Tuning 48.5 uT"}) {
    EXPECT_TRUE(std::holds_alternative<GsmText>(parse_line(line))) << line;
  }
  EXPECT_TRUE(std::get<GsmText>(parse_line("/datum  48500.00")).header);
}

TEST(GsmProtocol, DamageIsNoReading) {
  for (const std::string_view line :
       {"484.12", "48484", "115014.0 48484 99", "117014.0  48484.12 99", "115014.0  48484.12 999",
        "115014.0 48484.12 99 99", "115014.0 48484..12 99", "1150140000 48484.12 99", "115014.0 -48484.12 99",
        "115014.0  48484.12 1.2.3", "99", "04-22-2015"}) {
    EXPECT_TRUE(std::holds_alternative<Reject>(parse_line(line))) << line;
  }
}

TEST(GsmProtocol, TheClockString) {
  // Friday 22 April 2016 14:22:44 UTC, as in the maker's example.
  EXPECT_EQ(clock_string({1461334964'000'000'000}), "1604225142244");
}

}  // namespace
}  // namespace mgtd::drivers::gsm
