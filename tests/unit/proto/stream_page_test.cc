// SPDX-License-Identifier: Apache-2.0
// docs/stream.md is what a script is written from: it names every command and every state of a run.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "proto/control_codec.h"
#include "proto/run_request.h"
#include "proto/sensors_report.h"
#include "proto/status_codec.h"
#include "tests/support/checkout.h"
#include "tests/support/child_process.h"
#include "tests/support/whole_file.h"

namespace mgtd {
namespace {

std::string page() { return testing::whole_file(mgtd::testing::source_path("docs/stream.md")); }

TEST(StreamPage, NamesEveryCommand) {
  const std::string text = page();
  for (const std::string_view command : kControlCommandNames)
    EXPECT_THAT(text, ::testing::HasSubstr(fmt::format("`{}`", command)));
}

TEST(StreamPage, NamesEveryStateAndKeyOfARun) {
  const std::string text = page();
  for (int i = 0; i <= static_cast<int>(RunState::interrupted); ++i)
    EXPECT_THAT(text, ::testing::HasSubstr(fmt::format("`{}`", name(static_cast<RunState>(i)))));
  const auto run = to_json(RunStatus{});
  for (const auto& [key, value] : run.items())
    EXPECT_THAT(text, ::testing::HasSubstr(fmt::format("`{}`", key)));
}

TEST(StreamPage, NamesEveryKeyOfTheSensors) {
  const std::string text = page();
  const auto report = to_json(SensorsReport{.table = TableAngles{}});
  for (const auto& [key, value] : report.items())
    EXPECT_THAT(text, ::testing::HasSubstr(fmt::format("`{}`", key)));
  for (const auto& part : {report["sensors"][0], report["table"]})
    for (const auto& [key, value] : part.items())
      EXPECT_THAT(text, ::testing::HasSubstr(fmt::format("`{}`", key)));
}

TEST(StreamPage, NamesEveryArgumentOfARun) {
  const std::string text = page();
  const RunRequest all{1,
                       1,
                       1,
                       1,
                       1,
                       1,
                       1,
                       1,
                       30.0,
                       "list",
                       {{.number = 1,
                         .set = "random",
                         .sense = 1,
                         .dwell_s = 1,
                         .since_stop_s = 1,
                         .note = "warm it",
                         .line = 1}}};
  const nlohmann::json args = to_json(all);
  for (const auto& [key, value] : args.items())
    EXPECT_THAT(text, ::testing::HasSubstr(fmt::format("`{}`", key)));
  for (const auto& [key, value] : args["poses"][0].items())
    EXPECT_THAT(text, ::testing::HasSubstr(fmt::format("`{}`", key)));
}

}  // namespace
}  // namespace mgtd
