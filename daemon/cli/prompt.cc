// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/prompt.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <vector>

#include "proto/number.h"

namespace mgtd::daemon::cli {
namespace {

struct Word {
  std::string_view word;
  ControlCommand command;
};
constexpr std::array kWords{Word{"redo", ControlCommand::run_redo}, Word{"pause", ControlCommand::run_pause},
                            Word{"abort", ControlCommand::run_abort}};

}  // namespace

std::string question(const OperatorPrompt& prompt) {
  std::string out = prompt.again.empty() ? std::string() : prompt.again + "\n";
  const bool note = prompt.what == OperatorPrompt::What::note;
  return out + prompt.text +
         (note ? "\n  done, or pause, abort: " : "\n  azimuth pitch roll in deg, or redo, pause, abort: ");
}

Result<PromptAnswer> parse_answer(std::string_view line, const OperatorPrompt& prompt) {
  std::string text(line);
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  if (words.size() == 1) {
    for (const Word& known : kWords)
      if (words[0] == known.word) return PromptAnswer{known.command};
  }
  if (prompt.what == OperatorPrompt::What::note) {
    if (words.size() == 1 && words[0] == "done") return PromptAnswer{ControlCommand::run_resume};
    return fail(ErrorCode::usage, "that is not an answer", "type done when it is done, or pause, or abort");
  }
  const auto refuse = [](const std::string& found) {
    return fail(ErrorCode::usage, found, "three numbers in degrees as the scales say: azimuth pitch roll");
  };
  if (words.size() != 3)
    return refuse(
        fmt::format("{} word{} where three numbers are needed", words.size(), words.size() == 1 ? "" : "s"));
  PromptAnswer out;
  static constexpr std::array kKeys{"azimuth_deg", "pitch_deg", "roll_deg"};
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto value = parse_number(words[i]);
    if (!value) return refuse(fmt::format("'{}' is not a number", words[i]));
    out.args[kKeys[i]] = *value;
  }
  out.args["pose"] = prompt.pose;
  out.args["what"] = name(prompt.what);
  if (auto ok = parse_scale_entry(out.args); !ok) return tl::unexpected(ok.error());
  return out;
}

}  // namespace mgtd::daemon::cli
