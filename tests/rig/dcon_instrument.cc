// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/dcon_instrument.h"

#include <fmt/format.h>

namespace mgtd::rig {
namespace {

constexpr std::size_t kLongestCommand = 32;
constexpr double kThinking_s = 0.01;

}  // namespace

void DconInstrument::receive(std::string_view bytes, double now_s) {
  if (silent_) return;
  for (const char c : bytes) {
    if (c != '\r') {
      if (command_.size() < kLongestCommand) command_ += c;
      continue;
    }
    obey(command_, now_s + kThinking_s);
    command_.clear();
  }
}

void DconInstrument::obey(std::string_view command, double now_s) {
  if (command.size() < 3 || command.substr(1, 2) != "01") return;
  if (command == "#01") return put(values(now_s), now_s);
  put(command == "$01M" ? "!017017\r" : "?01\r", now_s);
}

std::string DconInstrument::values(double now_s) {
  if (frozen_ && !last_.empty()) return last_;
  last_ = ">";
  for (const Covariate& input : inputs_)
    last_ += saturated_ ? std::string("+9999") : fmt::format("{:+08.3f}", input.at(now_s));
  return last_ += '\r';
}

}  // namespace mgtd::rig
