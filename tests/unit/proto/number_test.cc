// SPDX-License-Identifier: Apache-2.0
#include "proto/number.h"

#include <gtest/gtest.h>

namespace mgtd {
namespace {

TEST(Number, AcceptsWhatInstrumentsPrint) {
  EXPECT_EQ(parse_number("+12345.6"), 12345.6);
  EXPECT_EQ(parse_number("-0.5"), -0.5);
  EXPECT_EQ(parse_number("1e-3"), 1e-3);
  EXPECT_EQ(parse_integer("+42"), 42);
}

TEST(Number, RefusesEverythingElse) {
  for (const char* text : {"", "+", "+-1", "nan", "inf", "-inf", "1.5 ", " 1.5", "1,5", "0x10", "1.5e"}) {
    EXPECT_FALSE(parse_number(text)) << '\'' << text << '\'';
  }
  EXPECT_FALSE(parse_integer("1.0"));
}

}  // namespace
}  // namespace mgtd
