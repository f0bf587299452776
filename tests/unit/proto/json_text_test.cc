// SPDX-License-Identifier: Apache-2.0
#include "proto/json_text.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace mgtd {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kText = R"({
 "name": "a \"quoted\" {",
 "sensors": [
  {"cx": 1.0, "on": true},
  {"cx": "one", "on": true}
 ]
})";

TEST(JsonText, BrokenTextIsToldByLineAndColumn) {
  const auto broken = parse_json_text("{\n \"a\": 1,\n \"b\" 2\n}", "write it again");
  ASSERT_FALSE(broken);
  EXPECT_EQ(broken.error().message, "line 3, column 6: not JSON from here on");
  EXPECT_EQ(broken.error().remedy, "write it again");
  const auto torn = parse_json_text("{\"a\": [1, 2", "");
  ASSERT_FALSE(torn);
  EXPECT_EQ(torn.error().message, "line 1, column 12: the text ends before the JSON does");
  EXPECT_FALSE(parse_json_text("", ""));
  EXPECT_TRUE(parse_json_text(kText, ""));
}

TEST(JsonText, AWrongKindIsToldByItsPathAndPlace) {
  const json example{{"name", ""}, {"sensors", {{{"cx", 0.0}, {"on", false}}}}};
  const auto wrong = misfit(example, json::parse(kText));
  ASSERT_TRUE(wrong);
  EXPECT_EQ(wrong->what, "sensors/1/cx: a number belongs here, not a text");
  EXPECT_EQ(wrong->text(kText), "line 5, column 10: " + wrong->what);
}

TEST(JsonText, AMissingKeyIsToldAtTheObjectThatLacksIt) {
  const auto wrong = misfit({{"sensors", {{{"cy", 0}}}}}, json::parse(kText));
  ASSERT_TRUE(wrong);
  EXPECT_EQ(wrong->text(kText), "line 4, column 3: sensors/0: the key 'cy' is missing");
  EXPECT_EQ(misfit({{"id", ""}}, json::object())->text("{}"), "line 1, column 1: the key 'id' is missing");
}

TEST(JsonText, ListsHaveTheLengthOfTheExampleWhereItHasSeveral) {
  EXPECT_FALSE(misfit({{"a", {1}}}, {{"a", {1, 2.5, 3}}}));
  EXPECT_FALSE(misfit({{"a", json::array()}}, {{"a", {"x", 2}}}));
  EXPECT_FALSE(misfit({{"a", json()}}, {{"a", "anything"}, {"more", 1}}));
  const auto wrong = misfit({{"a", {1, 2}}}, {{"a", {1, 2, 3}}});
  ASSERT_TRUE(wrong);
  EXPECT_THAT(wrong->what, HasSubstr("2 values belong here, not 3"));
}

TEST(JsonText, EveryCutOfATextHasAPlaceAndNoWordOfTheLibrary) {
  for (std::size_t n = 0; n < kText.size(); ++n) {
    const auto cut = parse_json_text(std::string_view(kText).substr(0, n), "");
    ASSERT_FALSE(cut) << n;
    EXPECT_THAT(cut.error().message, HasSubstr("line "));
    EXPECT_THAT(cut.error().message, Not(HasSubstr("json.exception")));
  }
}

}  // namespace
}  // namespace mgtd
