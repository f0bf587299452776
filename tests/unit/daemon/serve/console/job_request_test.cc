// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/job_request.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace mgtd::daemon::serve::console {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> words(const std::string& body, const std::vector<std::string>& model_options = {},
                               const std::string& who = {}) {
  const auto request = parse_job_request(body);
  EXPECT_TRUE(request) << request.error().text();
  return request ? job_words(*request, "/runs/a.mgtrun", "/runs/a.new", model_options, who)
                 : std::vector<std::string>{};
}

std::string refusal(const std::string& body) {
  const auto request = parse_job_request(body);
  EXPECT_FALSE(request) << body;
  return request ? "" : request.error().text();
}

TEST(JobRequest, IsACommandOfMgt) {
  EXPECT_THAT(words(R"({"verb":"explain","run":"a.mgtrun"})"),
              ElementsAre("explain", "/runs/a.mgtrun", "--confusion", "--impact", "--json"));
  EXPECT_THAT(
      words(
          R"({"verb":"add","run":"a.mgtrun","args":{"effect":"axis.cubic@s3.z","try":true,"force":false}})"),
      ElementsAre("add", "axis.cubic@s3.z", "/runs/a.mgtrun", "--try", "--json"));
  EXPECT_THAT(words(R"({"verb":"mask","run":"a.mgtrun","args":{"poses":[9,3,8,7],"why":"a car"}})"),
              ElementsAre("mask", "/runs/a.mgtrun", "3,7-9", "--why=a car", "--json"));
  EXPECT_THAT(words(R"({"verb":"define","run":"a","args":{"name":"lamp","formula":"k*lamp_A","prior":0.5}})"),
              ElementsAre("define", "/runs/a.mgtrun", "lamp", "k*lamp_A", "--prior=0.5", "--json"));
  EXPECT_THAT(words(R"({"verb":"import","run":"a.csv"})", {"--field=50000"}),
              ElementsAre("import", "/runs/a.mgtrun", "-o", "/runs/a.new", "--json"));
}

TEST(JobRequest, CarriesTheServersOwnModelOptions) {
  EXPECT_THAT(words(R"({"verb":"compare","run":"a","args":{"with":["axis.cubic"],"without":[4]}})",
                    {"--field=50000"}),
              ElementsAre("compare", "/runs/a.mgtrun", "--with=axis.cubic", "--without=4", "--field=50000",
                          "--poses", "--json"));
}

TEST(JobRequest, OnlyWhatLeavesAStepSaysWhoMadeIt) {
  const std::string who = "the console, from ::1";
  EXPECT_THAT(words(R"({"verb":"undo","run":"a"})", {}, who),
              ElementsAre("undo", "/runs/a.mgtrun", "--who=" + who, "--json"));
  EXPECT_THAT(words(R"({"verb":"drop","run":"a","args":{"effect":"axis.cubic","try":true}})", {}, who),
              ElementsAre("drop", "axis.cubic", "/runs/a.mgtrun", "--try", "--json"));
  for (const char* verb : {"compare", "import", "model"})
    EXPECT_THAT(words(std::string(R"({"run":"a","verb":")") + verb + "\"}", {}, who),
                Not(Contains(HasSubstr("--who"))));
}

/// What a client writes is a value and never an option, however it looks.
TEST(JobRequest, NoTextBecomesAnOption) {
  EXPECT_THAT(words(R"({"verb":"mask","run":"a","args":{"poses":[1],"why":"--socket=/x"}})"),
              ElementsAre("mask", "/runs/a.mgtrun", "1", "--why=--socket=/x", "--json"));
  for (const char* effect : {"--force", "-x", "", "axis.cubic\\u0000", "a\\nb"})
    refusal(std::string(R"({"verb":"add","run":"a","args":{"effect":")") + effect + "\"}}");
  EXPECT_THAT(refusal(R"({"verb":"define","run":"a","args":{"name":"lamp","formula":"-k"}})"),
              HasSubstr("write 0 in front"));
  refusal(R"({"verb":"define","run":"a","args":{"name":"--drop","formula":"k"}})");
}

TEST(JobRequest, WhatIsNotInTheTableIsRefused) {
  EXPECT_THAT(refusal(R"({"verb":"run","run":"a"})"), HasSubstr("there are: compare, explain"));
  EXPECT_THAT(refusal(R"({"verb":"explain","run":"a","args":{"socket":"/x"}})"), HasSubstr("no argument"));
  EXPECT_THAT(refusal(R"({"verb":"explain"})"), HasSubstr("\"run\""));
  EXPECT_THAT(refusal(R"({"verb":"mask","run":"a","args":{"poses":[1]}})"), HasSubstr("why is missing"));
  EXPECT_THAT(refusal(R"({"verb":"add","run":"a","args":{"effect":"axis.cubic","force":1}})"),
              HasSubstr("true or false"));
  refusal(R"({"verb":"mask","run":"a","args":{"poses":["1"],"why":"x"}})");
  refusal(R"({"verb":"mask","run":"a","args":{"poses":[-1],"why":"x"}})");  // would be an option
  refusal(R"({"verb":"mask","run":"a","args":{"poses":[99999999999],"why":"x"}})");
  refusal(R"({"verb":"define","run":"a","args":{"name":"x","formula":"k","prior":"1"}})");
  refusal(R"({"verb":"explain","run":"a","args":[]})");
  refusal("[]");
}

TEST(JobRequest, ATryChangesNothing) {
  const auto changes = [](const std::string& body) { return parse_job_request(body)->changes(); };
  EXPECT_TRUE(changes(R"({"verb":"add","run":"a","args":{"effect":"axis.cubic"}})"));
  EXPECT_FALSE(changes(R"({"verb":"add","run":"a","args":{"effect":"axis.cubic","try":true}})"));
  EXPECT_FALSE(changes(R"({"verb":"why","run":"a","args":{"effect":"axis.cubic"}})"));
  EXPECT_TRUE(changes(R"({"verb":"undo","run":"a"})"));
}

TEST(JobRequest, IsShownAsItIsTyped) {
  EXPECT_EQ(typed({"mask", "a run.mgtrun", "3", "--why=it's a car"}),
            "mask 'a run.mgtrun' 3 '--why=it'\\''s a car'");
}

}  // namespace
}  // namespace mgtd::daemon::serve::console
