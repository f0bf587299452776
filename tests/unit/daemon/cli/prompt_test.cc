// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/prompt.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace mgtd::daemon::cli {
namespace {

TEST(Prompt, NumbersAnswerThePromptThatWasShown) {
  const OperatorPrompt asked{.what = OperatorPrompt::What::mount, .pose = 7};
  const auto answer = parse_answer("20, 0 -5.5", asked);
  ASSERT_TRUE(answer) << answer.error().text();
  EXPECT_EQ(answer->command, ControlCommand::run_enter);
  const auto entry = parse_scale_entry(answer->args);
  ASSERT_TRUE(entry);
  EXPECT_TRUE(entry->answers(asked));
  EXPECT_FALSE(entry->answers({.what = OperatorPrompt::What::table, .pose = 7}));
  EXPECT_FALSE(entry->answers({.what = OperatorPrompt::What::mount, .pose = 8}));
}

TEST(Prompt, ANoteIsDone) {
  const OperatorPrompt note{.what = OperatorPrompt::What::note, .pose = 7};
  EXPECT_EQ(parse_answer("done", note).value().command, ControlCommand::run_resume);
  EXPECT_FALSE(parse_answer("20 0 0", note));
  EXPECT_FALSE(parse_answer("", note));
}

}  // namespace
}  // namespace mgtd::daemon::cli
