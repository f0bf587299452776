// SPDX-License-Identifier: Apache-2.0
#include "drivers/gcs2_protocol.h"

#include <gtest/gtest.h>

namespace mgtd::drivers::gcs2 {
namespace {

TEST(Gcs2Protocol, Commands) {
  EXPECT_EQ(set_servo("1", true), "SVO 1 1\n");
  EXPECT_EQ(set_servo("1", false), "SVO 1 0\n");
  EXPECT_EQ(reference("A"), "FRF A\n");
  EXPECT_EQ(move("1", 90), "MOV 1 90.000000\n");
  EXPECT_EQ(move("1", -0.1), "MOV 1 -0.100000\n");
  EXPECT_EQ(set_velocity("1", 10), "VEL 1 10.000000\n");
  EXPECT_EQ(query("POS?", "1"), "POS? 1\n");
  EXPECT_EQ(query("ERR?"), "ERR?\n");
}

TEST(Gcs2Protocol, Replies) {
  EXPECT_EQ(parse_value("1=90.0000000", "1"), 90.0);
  EXPECT_EQ(parse_value(" 1 = -1.5 ", "1"), -1.5);
  EXPECT_FALSE(parse_value("2=90.0000000", "1")) << "of another axis";
  EXPECT_FALSE(parse_value("1=", "1"));
  EXPECT_FALSE(parse_value("1=nan", "1"));
  EXPECT_FALSE(parse_value("90.0", "1"));
  EXPECT_EQ(parse_flag("1=1", "1"), true);
  EXPECT_EQ(parse_flag("1=0", "1"), false);
  EXPECT_FALSE(parse_flag("1=2", "1"));
  EXPECT_EQ(parse_error("10"), 10);
  EXPECT_EQ(parse_error("-1004"), -1004);
  EXPECT_FALSE(parse_error("1=1"));
  EXPECT_EQ(parse_moving("0"), 0U);
  EXPECT_EQ(parse_moving("1f"), 31U);
  EXPECT_FALSE(parse_moving("1=0"));
  EXPECT_FALSE(parse_moving("123456789"));
  EXPECT_EQ(parse_ready("\xB1"), true);
  EXPECT_EQ(parse_ready("\xB0"), false);
  EXPECT_FALSE(parse_ready("1"));
  EXPECT_EQ(parse_axes("1 \n2 \n3"), (std::vector<std::string>{"1", "2", "3"}));
}

TEST(Gcs2Protocol, EveryErrorHasWordsARemedyAndItsNumber) {
  for (const int error : {1, 2, 3, 5, 7, 8, 10, 15, 17, 23, 24, 25, 26, 27, 45, 49, 52, 53, 54, 9999, -7}) {
    const ErrorText text = explain(error);
    EXPECT_NE(text.what.find("GCS error " + std::to_string(error)), std::string::npos);
    EXPECT_FALSE(text.remedy.empty());
  }
}

}  // namespace
}  // namespace mgtd::drivers::gcs2
