// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/refusals.h"

#include <gmock/gmock.h>

#include <vector>

namespace mgtd::daemon::serve::console {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

Instant second(double s) { return Instant{} + from_seconds(s); }

/// A thousand within 100 seconds are two lines, and none is missing in the count.
TEST(Refusals, AThousandAreALineAMinute) {
  Refusals refusals;
  std::vector<std::string> lines;
  for (int i = 0; i < 1000; ++i) {
    if (auto line = refusals.add("127.0.0.1", "the token is wrong", second(0.1 * i))) lines.push_back(*line);
  }
  EXPECT_EQ(refusals.total(), 1000U);
  ASSERT_THAT(lines, SizeIs(2));
  EXPECT_EQ(lines[0], "console: refused to 127.0.0.1: the token is wrong");
  EXPECT_THAT(lines[1], HasSubstr("; 599 more were refused since the last such line"));
}

TEST(Refusals, OneAfterALongTimeIsOneLine) {
  Refusals refusals;
  EXPECT_TRUE(refusals.add("10.0.0.7", "control is for browsers on the rig's computer", second(0)));
  const auto line = refusals.add("10.0.0.8", "the token is wrong", second(Refusals::kBetweenLines_s));
  ASSERT_TRUE(line);
  EXPECT_THAT(*line, Not(HasSubstr("more were")));
}

}  // namespace
}  // namespace mgtd::daemon::serve::console
