// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/durable_file.h"

#include <gmock/gmock.h>

#include <fstream>
#include <string>

#include "tests/unit/daemon/temp_dir.h"

namespace mgtd::daemon::store {
namespace {

using ::testing::HasSubstr;

TEST(ReadFile, AnEmptyFileIsEmptyText) {
  const test::TempDir dir;
  std::ofstream{dir / "empty"};
  const auto text = read_file(dir / "empty");
  ASSERT_TRUE(text) << text.error().text();
  EXPECT_EQ(*text, "");
}

/// Longer than one piece of reading, and of a whole number of pieces.
TEST(ReadFile, ALongFileIsReadToItsEnd) {
  const test::TempDir dir;
  for (const std::size_t length : {1U << 16U, (1U << 17U) + 1}) {
    std::string bytes(length, '\0');
    for (std::size_t i = 0; i < length; ++i) bytes[i] = static_cast<char>(i * 7 / 5);
    std::ofstream(dir / "long", std::ios::binary) << bytes;
    const auto text = read_file(dir / "long");
    ASSERT_TRUE(text) << text.error().text();
    EXPECT_TRUE(*text == bytes) << length;
  }
}

TEST(ReadFile, AMissingFileAndADirectoryAreNamed) {
  const test::TempDir dir;
  const auto missing = read_file(dir / "none"), directory = read_file(dir.path());
  ASSERT_FALSE(missing || directory);
  EXPECT_THAT(missing.error().message, HasSubstr("cannot be read: No such file or directory"));
  EXPECT_THAT(directory.error().message, HasSubstr("is a directory"));
}

/// The first page of a process's memory is mapped nowhere: reading it fails after the file was opened.
TEST(ReadFile, AnErrorWhileReadingIsNotAnEmptyFile) {
  const auto text = read_file("/proc/self/mem");
  ASSERT_FALSE(text);
  EXPECT_THAT(text.error().message, HasSubstr("cannot be read: Input/output error"));
}

}  // namespace
}  // namespace mgtd::daemon::store
