// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/run_file_content.h"

#include <gmock/gmock.h>

namespace mgtd::daemon::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(RunFileContent, OfAPoseTableIsEmpty) {
  const auto content = run_file_content(store::PoseSource{}, {}, {});
  EXPECT_THAT(content.run, IsEmpty());
  for (const auto* table : {&content.masked, &content.judgements, &content.history})
    EXPECT_THAT(table->rows, IsEmpty());
}

TEST(RunFileContent, NamesTheRunAndWhenItStarted) {
  store::RunHeader header{.run_id = "r7", .rig = "table6", .started_utc = {}};
  EXPECT_EQ(run_file_content({.table = {}, .header = header}, {}, {}).run,
            "r7 on rig table6, start not recorded");
  header.started_utc = *parse_utc("2026-11-30T12:00:00Z");
  EXPECT_EQ(run_file_content({.table = {}, .header = header}, {}, {}).run,
            "r7 on rig table6, started 2026-11-30T12:00:00Z");
}

TEST(RunFileContent, TellsWhichPosesAreMaskedAndWhy) {
  const WallTime at = *parse_utc("2026-11-30T12:00:00Z");
  store::PoseSource source;
  source.masked = {{.number = 12, .because = "a car", .who = "ao", .at = at}};
  const auto content = run_file_content(
      source, {{.poses = 157, .found = "AMBIGUOUS", .next = "24 more poses", .minutes = 12.4}},
      {{.at = at, .who = "ao", .action = "mask", .spec = "12", .result = R"({"because":"a car"})"}});
  EXPECT_THAT(content.masked.rows, ElementsAre(ElementsAre("12", "a car", "2026-11-30T12:00:00Z", "ao")));
  EXPECT_THAT(content.judgements.rows, ElementsAre(ElementsAre("157", "AMBIGUOUS", "24 more poses", "12")));
  EXPECT_THAT(content.history.rows,
              ElementsAre(ElementsAre("2026-11-30T12:00:00Z", "mask", "12", "", "a car", "ao")));
}

}  // namespace
}  // namespace mgtd::daemon::cli
