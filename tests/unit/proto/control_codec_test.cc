// SPDX-License-Identifier: Apache-2.0
#include "proto/control_codec.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "proto/calibration_request.h"
#include "proto/run_request.h"
#include "tests/support/parameter_name.h"

namespace mgtd {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

TEST(ControlCodec, EveryCommandSurvivesItsEncoding) {
  for (std::size_t i = 0; i < kControlCommandNames.size(); ++i) {
    const ControlRequest request{static_cast<ControlCommand>(i), {{"id", "c1"}}, 7};
    const auto back = parse_control(encode(request));
    ASSERT_TRUE(back) << encode(request);
    EXPECT_EQ(back->command, request.command);
    EXPECT_EQ(back->args, request.args);
    EXPECT_EQ(back->id, request.id);
  }
}

TEST(ControlCodec, ReadsTheDocumentedRequest) {
  const auto request = parse_control(R"({"cmd":"run.start","args":{"step_deg":10,"random":121},"id":7})");
  ASSERT_TRUE(request);
  EXPECT_EQ(request->command, ControlCommand::run_start);
  const auto run = parse_run_request(request->args);
  ASSERT_TRUE(run) << run.error().text();
  EXPECT_EQ(run->step_deg, 10.0);
  EXPECT_EQ(run->random, 121);
  EXPECT_EQ(run->seed, std::nullopt);
}

struct Bad {
  const char* line;
  const char* message;
  const char* id;
};

std::string name_of(const ::testing::TestParamInfo<Bad>& info) {
  return testing::parameter_name(fmt::format("{} {}", info.index, info.param.message));
}

class BadControl : public ::testing::TestWithParam<Bad> {};

TEST_P(BadControl, IsRefusedUnderItsId) {
  const auto request = parse_control(GetParam().line);
  ASSERT_FALSE(request);
  EXPECT_THAT(request.error().error.message, HasSubstr(GetParam().message));
  EXPECT_NE(request.error().error.remedy, "");
  EXPECT_EQ(request.error().id.dump(), GetParam().id);
}

INSTANTIATE_TEST_SUITE_P(
    Lines, BadControl,
    ::testing::Values(Bad{"run.start", "is not JSON", "null"}, Bad{"[]", "not a JSON object", "null"},
                      Bad{R"({"id":4})", "no \"cmd\"", "4"},
                      Bad{R"({"cmd":5,"id":"a"})", "no \"cmd\"", "\"a\""},
                      Bad{R"({"cmd":"run.stop","id":4})", "'run.stop' does not exist", "4"},
                      Bad{R"({"cmd":"version","args":[1],"id":4})", "\"args\"", "4"},
                      Bad{R"({"cmd":"version","arg":{},"id":4})", "unknown key 'arg'", "4"},
                      Bad{R"({"cmd":"version","id":{"x":1}})", "neither a number nor text", "null"}),
    name_of);

TEST(ControlCodec, RepliesSurviveBothWays) {
  const auto good = parse_reply(encode_reply("x", nlohmann::ordered_json{{"a", 1}}));
  ASSERT_TRUE(good);
  EXPECT_EQ(good->id, "x");
  EXPECT_EQ(*good->result, Json({{"a", 1}}));
  for (const ErrorCode code :
       {ErrorCode::usage, ErrorCode::bad_input, ErrorCode::refused, ErrorCode::io, ErrorCode::unreachable,
        ErrorCode::protocol, ErrorCode::state, ErrorCode::internal}) {
    const auto bad = parse_reply(encode_reply(nullptr, fail(code, "found", "do this")));
    ASSERT_TRUE(bad);
    ASSERT_FALSE(bad->result);
    EXPECT_EQ(bad->result.error().code, code);
    EXPECT_EQ(bad->result.error().text(), "found; do this");
  }
}

/// A line within the limit that would need a hundred megabytes of stack.
TEST(ControlCodec, BracketsWithoutEndAreRefusedAndNotFollowed) {
  const std::string open(400'000, '['), close(400'000, ']');
  const auto deep = parse_control(R"({"cmd":"run.dry-run","id":7,"args":{"step_deg":)" + open + close + "}}");
  ASSERT_FALSE(deep);
  EXPECT_THAT(deep.error().error.message, ::testing::HasSubstr("nests more than 64 brackets"));
  EXPECT_FALSE(parse_control(open));
  EXPECT_FALSE(parse_reply(R"({"ok":true,"result":)" + open + close + "}"));
  // Brackets in text are text.
  EXPECT_TRUE(
      parse_control(R"({"cmd":"control.take","args":{"why":"\"[[[[)" + std::string(100, '{') + R"("}})"));
}

TEST(ControlCodec, TextThatIsNotUtf8DoesNotEndTheConversation) {
  EXPECT_THAT(encode_reply(nullptr, fail(ErrorCode::protocol, "table said \xff\xfe", "")),
              HasSubstr("table said"));
}

TEST(ControlCodec, WhatIsNoReplyIsSaid) {
  for (const char* line : {"", "{}", "SSH-2.0", R"({"ok":1})", R"({"ok":true})", R"({"ok":false})",
                           R"({"ok":false,"error":"x"})", "[]"}) {
    EXPECT_FALSE(parse_reply(line)) << line;
  }
}

TEST(RunRequest, SurvivesItsEncoding) {
  const RunRequest request{10.0, 121, 24, 3, 4.0, 8.5, 42, 0.5, 20.0, {}, {}};
  EXPECT_EQ(*parse_run_request(to_json(request)), request);
  EXPECT_EQ(*parse_run_request(Json::object()), RunRequest{});
  EXPECT_EQ(to_json(RunRequest{}), Json::object());
}

TEST(RunRequest, EachMistakeIsNamedWithItsLimits) {
  const auto message = [](const char* args) {
    const auto request = parse_run_request(Json::parse(args));
    return request ? std::string("accepted") : request.error().text();
  };
  EXPECT_THAT(message(R"({"step_deg":0})"), HasSubstr("step_deg is 0, not a number from 1 to 120"));
  EXPECT_THAT(message(R"({"step_deg":"10"})"), HasSubstr("step_deg is \"10\""));
  EXPECT_THAT(message(R"({"random":-1})"), HasSubstr("random is -1, not a whole number from 0 to 100000"));
  EXPECT_THAT(message(R"({"random":12.5})"), HasSubstr("random is 12.5"));
  EXPECT_THAT(message(R"({"random":99999999999999999999})"), HasSubstr("random is"));
  EXPECT_THAT(message(R"({"seed":-1})"), HasSubstr("seed is -1"));
  EXPECT_THAT(message(R"({"dwell":4})"),
              HasSubstr("no argument 'dwell'; its arguments are step_deg, random"));
  EXPECT_EQ(message(R"({"step_deg":null})"), "accepted");
}

TEST(CalibrationId, MustBeNamed) {
  EXPECT_EQ(*parse_calibration_id({{"id", "c1"}}), "c1");
  EXPECT_FALSE(parse_calibration_id(Json::object()));
  EXPECT_FALSE(parse_calibration_id({{"id", ""}}));
  EXPECT_FALSE(parse_calibration_id({{"id", 7}}));
}

TEST(CalibrationRequest, ForceAndContentAreRead) {
  const auto plain = parse_accept_request({{"id", "c1"}});
  ASSERT_TRUE(plain);
  EXPECT_FALSE(plain->force);
  EXPECT_TRUE(parse_accept_request({{"id", "c1"}, {"force", true}})->force);
  EXPECT_FALSE(parse_accept_request({{"id", "c1"}, {"force", "yes"}}));
  EXPECT_FALSE(parse_accept_request({{"force", true}}));
  EXPECT_EQ(parse_accept_request({{"id", "c1"}, {"why", "known"}})->why, "known");
  EXPECT_EQ(parse_reject_request({{"id", "c1"}, {"why", "a car"}})->why, "a car");
  EXPECT_FALSE(parse_reject_request({{"id", "c1"}}));
  EXPECT_FALSE(parse_reject_request({{"id", "c1"}, {"why", " \n"}}));
  EXPECT_FALSE(parse_reject_request({{"id", "c1"}, {"why", 7}}));
  EXPECT_FALSE(parse_reject_request({{"id", "c1"}, {"why", std::string(501, 'x')}}));
  EXPECT_FALSE(parse_reject_request({{"why", "a car"}}));
  const auto import =
      parse_import_request({{"calibration", {{"id", "c1"}}}, {"origin", "cal.json"}, {"accept", true}});
  ASSERT_TRUE(import);
  EXPECT_EQ(import->calibration.at("id"), "c1");
  EXPECT_EQ(import->origin, "cal.json");
  EXPECT_TRUE(import->accept);
  EXPECT_FALSE(import->force);
  EXPECT_FALSE(parse_import_request({{"calibration", "cal.json"}}));
  EXPECT_FALSE(parse_import_request({{"origin", "cal.json"}}));
  EXPECT_FALSE(parse_import_request({{"calibration", nlohmann::json::object()}, {"accept", 1}}));
}

}  // namespace
}  // namespace mgtd
