// SPDX-License-Identifier: Apache-2.0
#include "drivers/settings.h"

#include <gmock/gmock.h>

namespace mgtd::drivers {
namespace {

using ::testing::HasSubstr;

TEST(Settings, ValuesAndFallbacks) {
  Settings s("[table]", 3);
  s.set("whole", std::int64_t{7}, 4);
  s.set("texts", std::vector<std::string>{"a", "b"}, 5);
  EXPECT_EQ(s.number("whole", 1.5), 7.0) << "a whole number is a number";
  EXPECT_EQ(s.number("absent", 1.5), 1.5);
  EXPECT_EQ(s.texts("texts"), (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(s.texts("absent").empty());
  s.refuse_unknown();
  EXPECT_TRUE(s.errors().empty());
}

TEST(Settings, EveryMistakeWithItsLine) {
  Settings s("[table]", 3);
  s.set("number", std::string("x"), 4);
  s.set("texts", 1.0, 5);
  s.set("numbers", std::vector<double>{1, 2}, 6);
  s.set("baut", std::int64_t{9600}, 7);
  EXPECT_EQ(s.number("number", 2.0), 2.0);
  EXPECT_TRUE(s.texts("texts").empty());
  EXPECT_EQ(s.numbers("numbers", 3, {0, 0, 0}).size(), 3U);
  EXPECT_EQ(s.required_text("port"), "");
  static_cast<void>(s.integer("baud", 1));
  s.refuse_unknown();
  ASSERT_EQ(s.errors().size(), 5U);
  EXPECT_EQ(s.errors()[0].line, 4);
  EXPECT_EQ(s.errors()[1].line, 5);
  EXPECT_THAT(s.errors()[2].message, HasSubstr("a list of 3 numbers"));
  EXPECT_THAT(s.errors()[3].message, HasSubstr("[table]: 'port' is missing"));
  EXPECT_EQ(s.errors()[4].line, 7);
  EXPECT_THAT(s.errors()[4].message, HasSubstr("did you mean 'baud'?"));
}

}  // namespace
}  // namespace mgtd::drivers
