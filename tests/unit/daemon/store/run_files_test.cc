// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/run_files.h"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/unit/daemon/temp_dir.h"

namespace mgtd::daemon::store {
namespace {

using ::testing::ElementsAre;

RunHeader run_called(const std::string& id) {
  RunHeader header;
  header.run_id = id;
  return header;
}

std::vector<std::string> ids(RunFiles& files) {
  std::vector<std::string> out;
  for (const RunFiles::Entry& entry : files.last_first()) out.push_back(entry.path.stem().string());
  return out;
}

TEST(RunFiles, TheLastRunIsFirstWhateverItsName) {
  test::TempDir dir;
  ASSERT_TRUE(RunFiles(dir.path()).create(run_called("20350101T000000Z")));
  RunFiles later(dir.path());
  ASSERT_TRUE(later.create(run_called("20261121T100000Z")));
  ASSERT_TRUE(later.create(run_called("20261120T100000Z")));
  EXPECT_THAT(ids(later), ElementsAre("20261120T100000Z", "20261121T100000Z", "20350101T000000Z"));
}

TEST(RunFiles, RunsWithoutANumberComeBehindByTheirNames) {
  test::TempDir dir;
  for (const char* id : {"20261121T100000Z", "20350101T000000Z"})
    ASSERT_TRUE(RunFile::create(dir / (std::string(id) + ".mgtrun"), run_called(id)));
  RunFiles files(dir.path());
  ASSERT_TRUE(files.create(run_called("20261122T100000Z")));
  EXPECT_THAT(ids(files), ElementsAre("20261122T100000Z", "20350101T000000Z", "20261121T100000Z"));
}

TEST(RunFiles, AFileThatCannotBeReadIsLeftOut) {
  test::TempDir dir;
  std::ofstream(dir / "20350101T000000Z.mgtrun") << "no database";
  RunFiles files(dir.path());
  ASSERT_TRUE(files.create(run_called("20261121T100000Z")));
  EXPECT_THAT(ids(files), ElementsAre("20261121T100000Z"));
}

TEST(RunFiles, ARunThatIsRefusedTakesNoNumber) {
  test::TempDir dir;
  RunFiles files(dir.path());
  ASSERT_TRUE(files.create(run_called("r")));
  EXPECT_FALSE(files.create(run_called("r")));
  const auto next = files.create(run_called("s"));
  ASSERT_TRUE(next) << next.error().text();
  EXPECT_EQ(next->header().number, 2U);
}

}  // namespace
}  // namespace mgtd::daemon::store
