// SPDX-License-Identifier: Apache-2.0
#include "proto/line_framer.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace mgtd {
namespace {

using Seen = std::vector<std::string>;  // lines, and "!" for each report of an overlong one

Seen feed(LineFramer& framer, std::string_view bytes) {
  Seen seen;
  framer.feed(
      bytes, [&](std::string_view line) { seen.emplace_back(line); }, [&] { seen.emplace_back("!"); });
  return seen;
}

TEST(LineFramer, SplitsAtAnyByteAlike) {
  const std::string bytes = "one\r\n\n\r\ntwo\nfar too long a line\nthree\n";
  const Seen expected{"one", "two", "!", "!", "three"};
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
    LineFramer framer(8);
    Seen seen = feed(framer, bytes.substr(0, cut));
    const Seen rest = feed(framer, bytes.substr(cut));
    seen.insert(seen.end(), rest.begin(), rest.end());
    EXPECT_EQ(seen, expected) << "cut at " << cut;
  }
}

TEST(LineFramer, ALineOfExactlyTheLimitPasses) {
  LineFramer framer(5);
  EXPECT_EQ(feed(framer, "12345\n123456\n"), (Seen{"12345", "!"}));
}

TEST(LineFramer, KeepsNoMoreThanTheLimitAndGoesOnReporting) {
  LineFramer framer(100);
  std::size_t reports = 0;
  for (int i = 0; i < 50; ++i) {
    reports += feed(framer, std::string(37, 'x')).size();
    EXPECT_LE(framer.pending(), framer.limit());
  }
  EXPECT_EQ(reports, 50U * 37U / 100U);
  EXPECT_EQ(feed(framer, "\nok\n"), Seen{"ok"});
}

}  // namespace
}  // namespace mgtd
