// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/rotated_files.h"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/unit/daemon/temp_dir.h"

namespace mgtd::daemon::store {
namespace {

using std::chrono::hours;
using test::TempDir;
using ::testing::ElementsAre;

const auto kNow = std::filesystem::file_time_type::clock::now();

void write(const std::filesystem::path& path, hours ago) {
  std::ofstream(path) << std::string(100, 'x');
  std::filesystem::last_write_time(path, kNow - ago);
}

std::vector<std::string> names(const std::vector<RotatedFile>& files) {
  std::vector<std::string> out;
  for (const RotatedFile& file : files) out.push_back(file.path.filename());
  return out;
}

/// Names tell when a life began, by its clock.
TEST(RotatedFiles, AClockThatWasWrongDoesNotMakeOldFilesNew) {
  TempDir dir;
  write(dir / "raw-1800.000000.raw", hours{48});
  write(dir / "raw-9000.000000.raw", hours{-9000});  // by a clock in the future
  write(dir / "raw-0001.000000.raw", hours{24});     // began before the clock was set
  write(dir / "raw-1900.000000.raw", hours{2});
  write(dir / "raw-1900.000001.raw", hours{-9000});  // being written when the clock went wrong
  write(dir / "raw-1900.000002.raw", hours{1});
  const auto files = by_age(rotated_files(dir.path(), "raw-", ".raw"), "raw-1900", kNow);
  EXPECT_THAT(names(files), ElementsAre("raw-9000.000000.raw", "raw-1800.000000.raw", "raw-0001.000000.raw",
                                        "raw-1900.000000.raw", "raw-1900.000001.raw", "raw-1900.000002.raw"));
  EXPECT_EQ(remove_oldest(files, {.bytes = 350}, 100), 4U);
  EXPECT_THAT(names(rotated_files(dir.path(), "raw-", ".raw")),
              ElementsAre("raw-1900.000001.raw", "raw-1900.000002.raw"));
}

/// A computer without a clock of its own starts with the time of its last shutdown or an earlier one.
TEST(RotatedFiles, AClockThatIsAnHourBehindKeepsWhatWasJustMeasured) {
  TempDir dir;
  write(dir / "raw-1800.000000.raw", hours{48});
  write(dir / "raw-1890.000000.raw", hours{-1});
  const auto files = by_age(rotated_files(dir.path(), "raw-", ".raw"), "raw-1900", kNow);
  EXPECT_THAT(names(files), ElementsAre("raw-1800.000000.raw", "raw-1890.000000.raw"));
}

TEST(RotatedFiles, AFileOfTheFutureKeepsNoneThatIsTooOld) {
  TempDir dir;
  write(dir / "raw-1800.000000.raw", hours{48});
  write(dir / "raw-9000.000000.raw", hours{-9000});
  const auto files = by_age(rotated_files(dir.path(), "raw-", ".raw"), "raw-1900", kNow);
  EXPECT_EQ(remove_oldest(files, {.age = hours{24}}, 0), 1U);
  EXPECT_THAT(names(rotated_files(dir.path(), "raw-", ".raw")), ElementsAre("raw-9000.000000.raw"));
}

}  // namespace
}  // namespace mgtd::daemon::store
