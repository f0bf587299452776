// SPDX-License-Identifier: Apache-2.0
#include "proto/operator_prompt.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "proto/units.h"

namespace mgtd {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

TEST(OperatorPrompt, ReadsBackAsItWasWritten) {
  const OperatorPrompt asked{.what = OperatorPrompt::What::mount,
                             .pose = 37,
                             .mount = 2,
                             .target = {0, 0, to_rad(90)},
                             .text = "mounting 2",
                             .again = "look again"};
  const auto read = prompt_from_json(json::parse(to_json(asked).dump()));
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(to_json(*read), to_json(asked));
}

TEST(OperatorPrompt, AnEntryAnswersWhatItNames) {
  const OperatorPrompt asked{.what = OperatorPrompt::What::table, .pose = 7};
  json args{{"azimuth_deg", 20}, {"pitch_deg", 0}, {"roll_deg", -5.5}};
  const auto answers = [&] {
    const auto entry = parse_scale_entry(args);
    EXPECT_TRUE(entry) << entry.error().text();
    return entry && entry->answers(asked);
  };
  EXPECT_TRUE(answers()) << "it names nothing";
  args["pose"] = 7;
  args["what"] = "table";
  EXPECT_TRUE(answers());
  args["what"] = "mount";
  EXPECT_FALSE(answers());
  args["what"] = "table";
  args["pose"] = 8;
  EXPECT_FALSE(answers());
}

TEST(OperatorPrompt, WhatIsNoEntryIsRefused) {
  const json good{{"azimuth_deg", 20}, {"pitch_deg", 0}, {"roll_deg", 0}};
  const auto refusal = [&](const char* key, const json& value) {
    json args = good;
    args[key] = value;
    const auto entry = parse_scale_entry(args);
    return entry ? std::string() : entry.error().message;
  };
  EXPECT_THAT(refusal("pitch_deg", "up"), HasSubstr("'pitch_deg' is not a number"));
  EXPECT_THAT(refusal("roll_deg", 721), HasSubstr("outside 720 deg"));
  EXPECT_THAT(refusal("pose", "seven"), HasSubstr("'pose'"));
  EXPECT_THAT(refusal("what", "yaw"), HasSubstr("'what'"));
  EXPECT_THAT(refusal("yaw_deg", 1), HasSubstr("other keys"));
}

}  // namespace
}  // namespace mgtd
