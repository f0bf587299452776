// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/store_lock.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>

#include "tests/unit/daemon/temp_dir.h"

namespace mgtd::daemon::store {
namespace {

using ::testing::HasSubstr;

TEST(StoreLock, OneHasTheFolderAndTheOtherIsToldWho) {
  const test::TempDir dir;
  const auto first = StoreLock::take(dir / "store");
  ASSERT_TRUE(first) << first.error().text();
  const auto second = StoreLock::take(dir / "store");
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::state);
  EXPECT_THAT(second.error().text(), HasSubstr(fmt::format("mgtd with pid {}", ::getpid())));
}

TEST(StoreLock, EndsWithItsOwner) {
  const test::TempDir dir;
  { ASSERT_TRUE(StoreLock::take(dir.path())); }
  EXPECT_TRUE(StoreLock::take(dir.path()));
}

TEST(StoreLock, AFolderThatCannotBeIsNamed) {
  const test::TempDir dir;
  std::ofstream(dir / "file") << "x";
  const auto lock = StoreLock::take(dir / "file");
  ASSERT_FALSE(lock);
  EXPECT_EQ(lock.error().code, ErrorCode::io);
  EXPECT_THAT(lock.error().text(), HasSubstr("file"));
}

}  // namespace
}  // namespace mgtd::daemon::store
