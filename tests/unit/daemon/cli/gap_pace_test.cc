// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/gap_pace.h"

#include <gtest/gtest.h>

#include <vector>

namespace mgtd::daemon::cli {
namespace {

Instant at(int seconds) { return Instant{} + from_seconds(500 + seconds); }

/// The seconds at which a gap that lasts `seconds` is mentioned.
std::vector<int> mentions(int seconds) {
  GapPace pace;
  pace.begin(at(0));
  std::vector<int> out;
  for (int s = 0; s < seconds; ++s) {
    if (!pace.due(at(s))) continue;
    pace.mention(at(s));
    out.push_back(s);
  }
  return out;
}

TEST(GapPace, AShortGapIsNotMentionedBeforeItsEnd) { EXPECT_TRUE(mentions(10).empty()); }

TEST(GapPace, AnHourWithoutDevicesIsAHandfulOfLines) {
  EXPECT_EQ(mentions(3600), (std::vector<int>{10, 70, 670, 1270, 1870, 2470, 3070}));
}

TEST(GapPace, TheNextGapBeginsAnew) {
  GapPace pace;
  pace.begin(at(0));
  pace.mention(at(10));
  pace.begin(at(100));
  EXPECT_FALSE(pace.due(at(109)));
  EXPECT_TRUE(pace.due(at(110)));
  pace.mention(at(110));
  EXPECT_TRUE(pace.due(at(170)));
}

}  // namespace
}  // namespace mgtd::daemon::cli
