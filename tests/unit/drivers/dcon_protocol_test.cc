// SPDX-License-Identifier: Apache-2.0
#include "drivers/dcon_protocol.h"

#include <gtest/gtest.h>

namespace mgtd::drivers::dcon {
namespace {

std::vector<std::optional<double>> channels(std::string_view line) {
  const Reply reply = parse_reply(line, "01", false);
  const auto* values = std::get_if<Values>(&reply);
  return values == nullptr ? std::vector<std::optional<double>>{} : values->channels;
}

std::optional<Reject> rejected(std::string_view line, bool checksum = false) {
  const Reply reply = parse_reply(line, "01", checksum);
  const auto* why = std::get_if<Reject>(&reply);
  return why == nullptr ? std::nullopt : std::optional(*why);
}

TEST(DconProtocol, TheManualsExamples) {
  EXPECT_EQ(channels(">+026.35"), (std::vector<std::optional<double>>{26.35}));
  EXPECT_EQ(channels(">+025.12+054.12+150.12"), (std::vector<std::optional<double>>{25.12, 54.12, 150.12}));
  EXPECT_EQ(channels(">-012.50+001.00"), (std::vector<std::optional<double>>{-12.5, 1.0}));
}

TEST(DconProtocol, OutOfRangeIsNotANumber) {
  EXPECT_EQ(channels(">-0000+054.12+9999"),
            (std::vector<std::optional<double>>{std::nullopt, 54.12, std::nullopt}));
}

TEST(DconProtocol, WhatIsNoReadingIsRejectedByReason) {
  EXPECT_EQ(rejected(">4C53"), Reject::number) << "hexadecimal";
  EXPECT_EQ(rejected(">+025.1x"), Reject::number);
  EXPECT_EQ(rejected(">+02.5.1"), Reject::number);
  EXPECT_EQ(rejected(">+"), Reject::number);
  EXPECT_EQ(rejected(">"), Reject::length);
  EXPECT_EQ(rejected(""), Reject::length);
  EXPECT_EQ(rejected("+025.12"), Reject::framing) << "its beginning is lost";
  EXPECT_EQ(rejected("!027033"), Reject::framing) << "another module on the pair";
  std::string many = ">";
  for (int i = 0; i < 17; ++i) many += "+001.00";
  EXPECT_EQ(rejected(many), Reject::length);
}

TEST(DconProtocol, NameAndRefusal) {
  const Reply name = parse_reply("!017033", "01", false);
  ASSERT_TRUE(std::holds_alternative<Name>(name));
  EXPECT_EQ(std::get<Name>(name).text, "7033");
  EXPECT_TRUE(std::holds_alternative<Refusal>(parse_reply("?01", "01", false)));
}

/// '#'+'0'+'1' = 0x23+0x30+0x31 = 0x84.
TEST(DconProtocol, TheChecksumIsTheLowByteOfTheSum) {
  EXPECT_EQ(command("#01", false), "#01\r");
  EXPECT_EQ(command("#01", true), "#0184\r");
  const std::string sent = command(">+026.35", true);
  const std::string line = sent.substr(0, sent.size() - 1);
  EXPECT_FALSE(rejected(line, true));
  for (std::size_t i = 0; i < line.size(); ++i) {
    std::string damaged = line;
    damaged[i] = static_cast<char>(damaged[i] ^ 1);
    EXPECT_TRUE(rejected(damaged, true)) << damaged;
  }
}

}  // namespace
}  // namespace mgtd::drivers::dcon
