// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/gap_line.h"

#include <gtest/gtest.h>

namespace mgtd::daemon::cli {
namespace {

TEST(GapLine, GapsThatFollowEachOtherAreOne) {
  GapLine line;
  EXPECT_TRUE(line.empty());
  line.add(5300, 5349, "s2: silent");
  EXPECT_EQ(line.text(), "gap: 50 samples, 5300 to 5349, are missing: s2: silent");
  line.add(5350, 5399, "s2: silent");
  line.add(5400, 5401, "s2: not measuring yet");
  EXPECT_EQ(line.text(), "gap: 102 samples, 5300 to 5401, are missing: s2: silent, s2: not measuring yet");
  line.clear();
  EXPECT_TRUE(line.empty());
}

TEST(GapLine, SamplesBetweenThemAreNotCalledMissing) {
  GapLine line;
  line.add(10, 10, "s1: frame lost");
  EXPECT_EQ(line.text(), "gap: sample 10 is missing: s1: frame lost");
  line.add(15, 19, "s1: frame lost");
  EXPECT_EQ(line.text(), "gap: 6 samples of 10 to 19 are missing: s1: frame lost");
}

}  // namespace
}  // namespace mgtd::daemon::cli
