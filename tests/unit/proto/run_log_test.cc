// SPDX-License-Identifier: Apache-2.0
#include "proto/run_log.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace mgtd {
namespace {

TEST(RunLog, TellsTheLatestEntriesAndHowManyItLeavesOut) {
  std::vector<RunLogEntry> all;
  for (std::size_t i = 0; i < RunLog::kMostEntries + 3; ++i)
    all.push_back({{static_cast<std::int64_t>(i) * 1'000'000'000}, std::to_string(i)});
  const RunLog log = latest_of("monday", all);
  EXPECT_EQ(log.left_out, 3U);
  ASSERT_EQ(log.entries.size(), RunLog::kMostEntries);
  EXPECT_EQ(log.entries.front().what, "3");
  EXPECT_EQ(log.entries.back().what, std::to_string(RunLog::kMostEntries + 2));
  EXPECT_EQ(latest_of("monday", {all.front()}).left_out, 0U);
}

TEST(RunLog, IsAnObject) {
  const RunLog log = latest_of("monday", {{{1'500'000'000}, "pose 3 is bad"}});
  EXPECT_EQ(to_json(log).dump(), R"({"run_id":"monday","left_out":0,"events":[{"t":")" +
                                     format_utc({1'500'000'000}) + R"(","what":"pose 3 is bad"}]})");
  EXPECT_EQ(to_json(RunLog{}).dump(), R"({"run_id":"","left_out":0,"events":[]})");
}

}  // namespace
}  // namespace mgtd
