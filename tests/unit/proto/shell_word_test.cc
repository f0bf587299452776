// SPDX-License-Identifier: Apache-2.0
#include "proto/shell_word.h"

#include <gtest/gtest.h>

namespace mgtd {
namespace {

TEST(ShellWord, PlainWordsStayAsTheyAre) {
  EXPECT_EQ(shell_word("axis.hysteresis@s2,w=0.1"), "axis.hysteresis@s2,w=0.1");
  EXPECT_EQ(shell_word("../runs/monday.mgtrun"), "../runs/monday.mgtrun");
}

TEST(ShellWord, WhatAShellWouldTakeForItsOwnIsQuoted) {
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_word("my run.csv"), "'my run.csv'");
  EXPECT_EQ(shell_word("(u/50000)*x"), "'(u/50000)*x'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word("a;rm"), "'a;rm'");
}

}  // namespace
}  // namespace mgtd
