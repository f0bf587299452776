// SPDX-License-Identifier: Apache-2.0
// `--json` prints one object whatever the arguments and paths were: bytes that are not UTF-8 are replaced.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "daemon/cli/command.h"

namespace mgtd::daemon::cli {
namespace {

constexpr const char* kReplaced = "run-\xEF\xBF\xBD.csv";  // U+FFFD

TEST(PrintJson, ReplacesWhatIsNotUtf8InValuesAndKeys) {
  ::testing::internal::CaptureStdout();
  print_json({{"file", "run-\xFF.csv"}, {"run-\xFF.csv", 1}});
  const auto printed = nlohmann::json::parse(::testing::internal::GetCapturedStdout());
  EXPECT_EQ(printed.at("file"), kReplaced);
  EXPECT_EQ(printed.at(kReplaced), 1);
}

TEST(PrintJson, AnErrorThatNamesAPathWhichIsNotUtf8IsPrinted) {
  Session session;
  session.json = true;
  ::testing::internal::CaptureStdout();
  EXPECT_NE(print_error(session, Error{ErrorCode::io, "run-\xFF.csv: no such file", "name another"}), 0);
  const auto printed = nlohmann::json::parse(::testing::internal::GetCapturedStdout());
  EXPECT_EQ(printed.at("error").at("message"), std::string(kReplaced) + ": no such file");
}

}  // namespace
}  // namespace mgtd::daemon::cli
