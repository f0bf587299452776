// SPDX-License-Identifier: Apache-2.0
#include "daemon/journal.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/unit/daemon/full_disk.h"
#include "tests/unit/daemon/temp_dir.h"

namespace mgtd::daemon {
namespace {

using test::FullDisk;
using test::TempDir;

Instant at(double s) { return Instant{from_seconds(s)}; }

JournalConfig config_in(const TempDir& dir) {
  JournalConfig config;
  config.directory = dir.path() / "raw";
  config.name = "r1";
  config.header = {"cross", "r1"};
  return config;
}

std::string payloads(const std::filesystem::path& file, bool whole = true) {
  std::ifstream in(file, std::ios::binary);
  RawLogDecoder decoder;
  decoder.feed(std::string(std::istreambuf_iterator<char>(in), {}));
  std::string all;
  while (const auto record = decoder.next()) all += record->bytes;
  EXPECT_EQ(static_cast<bool>(decoder.finish()), whole) << file;
  return all;
}

TEST(Journal, IsOnDiskWithinItsPeriodAndComplete) {
  TempDir dir;
  std::filesystem::path file;
  {
    auto journal = Journal::open(config_in(dir), at(0)).value();
    file = journal.file();
    journal.append({0, RawDirection::received, {}, "*0102"});
    journal.tick(at(0.4));
    EXPECT_EQ(std::filesystem::file_size(file), 0U);
    journal.tick(at(0.5));
    EXPECT_EQ(payloads(file), "*0102");
    journal.append({1, RawDirection::sent, {}, "#01CS"});
    const Journal moved = std::move(journal);
    EXPECT_TRUE(moved.recording());
  }
  EXPECT_EQ(payloads(file), "*0102#01CS");
}

TEST(Journal, RotatesAndNeverWritesOver) {
  TempDir dir;
  auto config = config_in(dir);
  config.rotate_bytes = 1000;
  config.buffer_bytes = 100;
  std::string sent;
  for (int opening = 0; opening < 2; ++opening) {
    auto journal = Journal::open(config, at(0)).value();
    for (int i = 0; i < 60; ++i) {
      const std::string bytes = "line " + std::to_string(100 * opening + i) + "\r";
      sent += bytes;
      journal.append({2, RawDirection::received, {}, bytes});
    }
  }
  std::string found;
  int files = 0;
  for (; std::filesystem::exists(config.directory / ("r1.00" + std::to_string(files) + ".raw")); ++files) {
    found += payloads(config.directory / ("r1.00" + std::to_string(files) + ".raw"));
  }
  EXPECT_GT(files, 4);
  EXPECT_EQ(found, sent);
}

TEST(Journal, FullDiskStopsRecordingOnceAndSaysSo) {
  TempDir dir;
  auto config = config_in(dir);
  config.buffer_bytes = 100;
  auto journal = Journal::open(config, at(0)).value();
  const auto first = journal.file();
  {
    const FullDisk full(2000);
    for (int i = 0; i < 200; ++i) journal.append({0, RawDirection::received, {}, "0123456789"});
    EXPECT_FALSE(journal.recording());
    EXPECT_GT(journal.bytes_lost(), 0U);
    const auto error = journal.take_error();
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code, ErrorCode::io);
    EXPECT_FALSE(journal.take_error());
    journal.tick(at(100));
  }
  EXPECT_GT(payloads(first, false).size(), 300U);
  ASSERT_TRUE(journal.retry(at(101)));
  journal.append({0, RawDirection::received, {}, "again"});
  journal.tick(at(102));
  EXPECT_NE(journal.file(), first);
  EXPECT_EQ(payloads(journal.file()), "again");
}

TEST(Journal, RefusesADirectoryItCannotHave) {
  TempDir dir;
  auto config = config_in(dir);
  std::ofstream(dir / "raw") << "a file";
  const auto refused = Journal::open(config, at(0));
  ASSERT_FALSE(refused);
  EXPECT_FALSE(refused.error().remedy.empty());
}

}  // namespace
}  // namespace mgtd::daemon
