// SPDX-License-Identifier: Apache-2.0
#include "proto/watch_request.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/parameter_name.h"

namespace mgtd {
namespace {

using ::testing::HasSubstr;

StreamClasses only(StreamClass c) {
  StreamClasses set;
  set.add(c);
  return set;
}

TEST(WatchRequest, ReadsTheDocumentedLine) {
  const auto request =
      parse_watch(R"({"watch":{"class":["TENSOR","STATUS","RUN","SENSORS"],"rate_hz":10,"from_seq":null}})");
  ASSERT_TRUE(request) << request.error().text();
  EXPECT_EQ(request->classes, StreamClasses::all());
  EXPECT_EQ(request->rate_hz, 10.0);
  EXPECT_EQ(request->from_seq, std::nullopt);
}

TEST(WatchRequest, WhatIsLeftOutOrNullMeansEverythingFromNowOn) {
  for (const char* line : {R"({"watch":{}})", R"({"watch":{"class":null,"rate_hz":null,"from_seq":null}})"}) {
    const auto request = parse_watch(line);
    ASSERT_TRUE(request) << line;
    EXPECT_EQ(*request, WatchRequest{}) << line;
  }
}

TEST(WatchRequest, SamplesBringTheirGapsAndNothingElseDoes) {
  EXPECT_TRUE(parse_watch(R"({"watch":{"class":["TENSOR"]}})")->classes.has(StreamClass::gap));
  EXPECT_FALSE(parse_watch(R"({"watch":{"class":["RUN","STATUS"]}})")->classes.has(StreamClass::gap));
  EXPECT_FALSE(parse_watch(R"({"watch":{"class":[]}})")->classes.any());
}

TEST(WatchRequest, AReaderMayLeaveOutTheSensors) {
  EXPECT_TRUE(WatchRequest{}.classes.has(StreamClass::sensors));
  EXPECT_FALSE(
      parse_watch(R"({"watch":{"class":["TENSOR","STATUS","RUN"]}})")->classes.has(StreamClass::sensors));
}

TEST(WatchRequest, SurvivesItsOwnEncoding) {
  for (const auto& classes : {StreamClasses::all(), only(StreamClass::run), only(StreamClass::gap),
                              only(StreamClass::sensors), StreamClasses{}}) {
    const WatchRequest request{classes, 12.5, 18'446'744'073'709'551'615U};
    const auto back = parse_watch(encode(request));
    ASSERT_TRUE(back) << encode(request);
    EXPECT_EQ(*back, request);
  }
}

struct Bad {
  const char* line;
  const char* message;
};

std::string name_of(const ::testing::TestParamInfo<Bad>& info) {
  return testing::parameter_name(fmt::format("{} {}", info.index, info.param.message));
}

class BadWatch : public ::testing::TestWithParam<Bad> {};

TEST_P(BadWatch, IsRefusedWithWhatWasFoundAndARemedy) {
  const auto request = parse_watch(GetParam().line);
  ASSERT_FALSE(request);
  EXPECT_THAT(request.error().message, HasSubstr(GetParam().message));
  EXPECT_NE(request.error().remedy, "");
}

INSTANTIATE_TEST_SUITE_P(
    Lines, BadWatch,
    ::testing::Values(Bad{R"({"watch":{"class":["TENSOR")", "not JSON from character 28"},
                      Bad{"hello", "'hello' is not JSON from character 1"},
                      Bad{"\xff\xfe\x01", "'...' is not JSON"}, Bad{"[1,2]", "not a JSON object"},
                      Bad{"{}", "is no watch"}, Bad{R"({"watch":7})", "watch is not an object"},
                      Bad{R"({"watch":{},"x":1})", "is no watch"},
                      Bad{R"({"watch":{"class":["TENSER"]}})", R"(class "TENSER" does not exist)"},
                      Bad{R"({"watch":{"class":[7]}})", "class 7 does not exist"},
                      Bad{R"({"watch":{"class":"TENSOR"}})", "not a list"},
                      Bad{R"({"watch":{"rate_hz":0}})", "rate_hz is 0"},
                      Bad{R"({"watch":{"rate_hz":-1}})", "rate_hz is -1"},
                      Bad{R"({"watch":{"rate_hz":1e9}})", "from 0.001 to 10000"},
                      Bad{R"({"watch":{"rate_hz":"fast"}})", "rate_hz is \"fast\""},
                      Bad{R"({"watch":{"from_seq":-3}})", "from_seq is -3"},
                      Bad{R"({"watch":{"from_seq":1.5}})", "from_seq is 1.5"},
                      Bad{R"({"watch":{"rate":10}})", "watch has no key 'rate'"},
                      Bad{R"({"cmd":"run.start"})", "read-only"}),
    name_of);

TEST(WatchRequest, RemediesNameWhatExists) {
  EXPECT_THAT(parse_watch(R"({"watch":{"class":["X"]}})").error().remedy,
              HasSubstr("TENSOR, GAP, STATUS, RUN, SENSORS"));
  EXPECT_THAT(parse_watch(R"({"cmd":"run.abort"})").error().remedy, HasSubstr("control socket"));
}

}  // namespace
}  // namespace mgtd
