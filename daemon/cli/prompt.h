// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "proto/control_codec.h"
#include "proto/operator_prompt.h"

/// These functions hold the dialogue with the operator of a run that is set by hand: text comes in, requests
/// go out.
namespace mgtd::daemon::cli {

/// What to do on a line that was typed at a prompt.
struct PromptAnswer {
  ControlCommand command{ControlCommand::run_enter};
  nlohmann::json args = nlohmann::json::object();
};

/// "pose 3 of 36: turn the table to ... [azimuth pitch roll, redo, pause, abort] "; for a note: "done".
[[nodiscard]] std::string question(const OperatorPrompt& prompt);

/// Three numbers in degrees: azimuth, pitch, roll, with or without commas; or redo, pause, abort. Where a
/// note is asked for, "done" instead of the numbers. An empty line is no answer: the target is never taken
/// for a reading. Numbers answer this prompt and no other.
[[nodiscard]] Result<PromptAnswer> parse_answer(std::string_view line, const OperatorPrompt& prompt);

}  // namespace mgtd::daemon::cli
