// SPDX-License-Identifier: Apache-2.0
#include "proto/time.h"

#include <gtest/gtest.h>

namespace mgtd {
namespace {

TEST(Time, FormatsAndParsesUtc) {
  const WallTime t{1'795'255'200'123'456'000};
  EXPECT_EQ(format_utc(t), "2026-11-21T10:00:00.123456Z");
  EXPECT_EQ(parse_utc("2026-11-21T10:00:00.123456Z").value(), t);
  EXPECT_EQ(parse_utc("1969-12-31T23:59:59.5Z").value().ns, -500'000'000);
  EXPECT_EQ(format_utc(WallTime{-500'000'000}), "1969-12-31T23:59:59.500000Z");
}

TEST(Time, ReachesAsFarAsNanosecondsDo) {
  for (const char* text : {"1678-01-01T00:00:00.000000Z", "2261-12-31T23:59:59.000000Z"})
    EXPECT_EQ(format_utc(parse_utc(text).value()), text);
}

TEST(Time, RefusesTextThatIsNotUtc) {
  for (const char* text : {"", "2026-11-21", "2026-11-21T10:00:00", "2026-11-21T10:00:00+01:00",
                           "2026-02-30T10:00:00Z", "2026-11-21T24:00:00Z", "2026-11-21T10:00:00.Z",
                           "2026-11-21T10:00:00.1234567890Z", "2026-11-21T-1:00:00Z", "0001-01-01T00:00:00Z",
                           "1677-09-21T00:12:43Z", "2262-04-11T23:47:17Z", "9999-12-31T23:59:59Z"}) {
    EXPECT_FALSE(parse_utc(text)) << text;
  }
}

}  // namespace
}  // namespace mgtd
