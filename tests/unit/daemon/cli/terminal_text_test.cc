// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/terminal_text.h"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <sstream>

#include "calib/report/seen_width.h"

namespace mgtd::daemon::cli {
namespace {

using ::testing::HasSubstr;

TEST(TerminalText, ALineThatFitsStays) {
  EXPECT_EQ(fitted("device   state\ns1       live\n", 20), "device   state\ns1       live\n");
}

TEST(TerminalText, WhatIsBrokenOffStandsBelowItsColumn) {
  EXPECT_EQ(fitted("  site.gradient   needs the table angles of every pose\n", 40),
            "  site.gradient   needs the table angles\n"
            "                  of every pose\n");
}

TEST(TerminalText, AParagraphGoesOnAtTheMargin) {
  EXPECT_EQ(fitted("One line that is longer than it may be\n", 20),
            "One line that is\nlonger than it may\nbe\n");
}

TEST(TerminalText, AWordThatIsTooLongStaysWhole) {
  EXPECT_EQ(fitted("see /a/path/that/is/far/too/long now\n", 20), "see\n/a/path/that/is/far/too/long\nnow\n");
}

TEST(TerminalText, ACommandToCopyStaysWhole) {
  const std::string command = "  mgt define run.mgtrun law1 'T_degC - 20' --unit nT/degC\n";
  EXPECT_EQ(fitted(command, 20), command);
}

TEST(TerminalText, BlanksAtTheEndOfARowMakeNoLine) {
  EXPECT_EQ(fitted("noise           0.019  \n", 22), "noise           0.019\n");
}

TEST(TerminalText, WidthIsCountedInCharacters) {
  EXPECT_EQ(fitted("12 ± 3 ± 4 ± 5 ± 6 ±\n", 21), "12 ± 3 ± 4 ± 5 ± 6 ±\n");
}

TEST(TerminalText, EveryOutputIsAsWideAsItsTerminalAndColouredOnlyThere) {
  EXPECT_FALSE(look_of({}, "auto").width);
  EXPECT_FALSE(look_of({}, "auto").colored);
  EXPECT_TRUE(look_of({}, "always").colored);
  const Output terminal{.terminal = true, .columns = 90, .no_color = "", .term = "xterm"};
  EXPECT_EQ(look_of(terminal, "auto").width, 90U);
  EXPECT_TRUE(look_of(terminal, "auto").colored);
  EXPECT_FALSE(look_of(terminal, "never").colored);
  EXPECT_FALSE(look_of({true, 90, "1", "xterm"}, "auto").colored);
  EXPECT_TRUE(look_of({true, 90, "1", "xterm"}, "always").colored);
  EXPECT_FALSE(look_of({true, 90, "", "dumb"}, "auto").colored);
}

TEST(TerminalText, JudgementsHaveTheColourOfTheirMeaning) {
  EXPECT_EQ(colored("PASS\n"), "\x1b[32mPASS\x1b[0m\n");
  EXPECT_EQ(colored("PARTIAL: site.gradient\n"), "\x1b[33mPARTIAL\x1b[0m: site.gradient\n");
  EXPECT_EQ(colored("  FAIL  residual  2.0 nT\n"), "  \x1b[31mFAIL\x1b[0m  residual  2.0 nT\n");
  EXPECT_EQ(colored("s1       live\n"), "s1       \x1b[32mlive\x1b[0m\n");
  EXPECT_EQ(colored("s2       gone      12\n"), "s2       \x1b[31mgone\x1b[0m      12\n");
  EXPECT_EQ(colored("judged    near source\n"), "judged    \x1b[31mnear source\x1b[0m\n");
  EXPECT_EQ(colored("joint calibration c1 of 36 poses: NOT ACCEPTED\n"),
            "joint calibration c1 of 36 poses: \x1b[31mNOT ACCEPTED\x1b[0m\n");
}

TEST(TerminalText, WordsInASentenceAreNoJudgement) {
  for (const char* text : {"it is ok to go on\n", "the sensors live on\n", "failed to find PASS\n"})
    EXPECT_EQ(colored(text), text);
}

/// Words in their order, whatever stands between them.
std::vector<std::string> words(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

RC_GTEST_PROP(TerminalText, NoWordIsLostAndOnlyLongWordsStandOut, ()) {
  const auto text = *rc::gen::container<std::string>(rc::gen::element('a', 'b', ' ', ' ', '\n'));
  const auto width = *rc::gen::inRange<std::size_t>(20, 60);
  const std::string out = fitted(text, width);
  RC_ASSERT(words(out) == words(text));
  std::istringstream lines(out);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
    RC_ASSERT(line.size() <= width || line.find(' ', begin) == std::string::npos ||
              line.find("  ", begin) != std::string::npos);
  }
}

}  // namespace
}  // namespace mgtd::daemon::cli
