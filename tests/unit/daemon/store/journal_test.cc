// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/journal.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "daemon/store/durable_file.h"
#include "tests/unit/daemon/full_disk.h"
#include "tests/unit/daemon/temp_dir.h"

namespace mgtd::daemon::store {
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
  RawLogDecoder decoder;
  decoder.feed(read_file(file).value());
  std::string all;
  while (const auto record = decoder.next()) all += record->bytes;
  EXPECT_EQ(static_cast<bool>(decoder.finish()), whole) << file;
  return all;
}

/// Of one file.
std::uint64_t header_bytes() { return encode_header({"cross", "r1"}).size(); }

void sync(Journal& journal, int os_error = 0) {
  for (const int fd : journal.take_syncs()) {
    ::close(fd);
    journal.synced(os_error);
  }
}

TEST(Journal, IsOnDiskWithinItsPeriodAndComplete) {
  TempDir dir;
  std::filesystem::path file;
  {
    Journal journal(config_in(dir), at(0));
    file = journal.file();
    journal.append({0, RawDirection::received, {}, "*0102"});
    journal.tick(at(0.4));
    EXPECT_EQ(std::filesystem::file_size(file), header_bytes());
    journal.tick(at(0.5));
    EXPECT_EQ(payloads(file), "*0102");
    journal.append({1, RawDirection::sent, {}, "#01CS"});
    EXPECT_TRUE(journal.recording());
  }
  EXPECT_EQ(payloads(file), "*0102#01CS");
}

TEST(Journal, SyncsWhenDueAndLeavesItToOthers) {
  TempDir dir;
  Journal journal(config_in(dir), at(0));
  journal.append({0, RawDirection::received, {}, "*0102"});
  journal.tick(at(1));
  EXPECT_TRUE(journal.take_syncs().empty()) << "not due yet";
  journal.tick(at(10));
  const auto due = journal.take_syncs();
  ASSERT_EQ(due.size(), 1U);
  EXPECT_EQ(::fdatasync(due[0]), 0);
  ::close(due[0]);
  EXPECT_TRUE(journal.take_syncs().empty());
  journal.synced(0);
  EXPECT_TRUE(journal.recording());
  journal.synced(EIO);
  EXPECT_FALSE(journal.recording());
  ASSERT_TRUE(journal.trouble());
}

std::string all_payloads(const JournalConfig& config) {
  std::string found;
  for (const RotatedFile& file : rotated_files(config.directory, "r1.", ".raw")) found += payloads(file.path);
  return found;
}

TEST(Journal, RotatesAndNeverWritesOver) {
  TempDir dir;
  auto config = config_in(dir);
  config.rotate_bytes = 1000;
  config.buffer_bytes = 100;
  std::string sent;
  for (int opening = 0; opening < 2; ++opening) {
    Journal journal(config, at(0));
    for (int i = 0; i < 60; ++i) {
      const std::string bytes = "line " + std::to_string(100 * opening + i) + "\r";
      sent += bytes;
      journal.append({2, RawDirection::received, {}, bytes});
    }
    sync(journal);
  }
  EXPECT_GT(rotated_files(config.directory, "r1.", ".raw").size(), 4U);
  EXPECT_EQ(all_payloads(config), sent);
}

TEST(Journal, BeginsANewFileWhenOneIsOld) {
  TempDir dir;
  auto config = config_in(dir);
  Journal journal(config, at(0));
  for (double t_s = 0; t_s < 3 * 86'400; t_s += 3600) {
    journal.append({2, RawDirection::received, {}, "x"});
    journal.tick(at(t_s));
    sync(journal);
  }
  EXPECT_EQ(rotated_files(config.directory, "r1.", ".raw").size(), 3U);
}

TEST(Journal, TheOldestGoWhenThereAreTooManyOfTheWholeFamily) {
  TempDir dir;
  auto config = config_in(dir);
  config.rotate_bytes = 1000;
  config.buffer_bytes = 100;
  config.family = "r";
  config.keep.bytes = 5000;
  std::filesystem::create_directories(config.directory);
  std::ofstream(config.directory / "other.raw") << std::string(9000, 'x');
  for (const char* life : {"r0", "r1"}) {
    config.name = life;
    Journal journal(config, at(0));
    for (int i = 0; i < 400; ++i) journal.append({2, RawDirection::received, {}, "0123456789"});
    EXPECT_GT(journal.files_removed(), 5U);
    std::uint64_t total = 0;
    for (const RotatedFile& file : rotated_files(config.directory, "r", ".raw")) total += file.bytes;
    EXPECT_LE(total, config.keep.bytes + config.buffer_bytes);
    sync(journal);
  }
  EXPECT_TRUE(rotated_files(config.directory, "r0", ".raw").empty()) << "the older life went first";
  EXPECT_TRUE(std::filesystem::exists(config.directory / "other.raw"));
}

TEST(Journal, FilesThatAreTooOldGo) {
  TempDir dir;
  auto config = config_in(dir);
  config.keep.age = std::chrono::hours{24};
  std::filesystem::path old;
  {
    const Journal journal(config, at(0));
    old = journal.file();
  }
  std::filesystem::last_write_time(old, std::filesystem::last_write_time(old) - std::chrono::hours{25});
  const Journal journal(config, at(0));
  EXPECT_FALSE(std::filesystem::exists(old));
  EXPECT_TRUE(std::filesystem::exists(journal.file()));
}

TEST(Journal, FullDiskStopsRecordingOnceAndItGoesOnByItself) {
  TempDir dir;
  auto config = config_in(dir);
  config.buffer_bytes = 100;
  Journal journal(config, at(0));
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
    EXPECT_TRUE(journal.trouble());
  }
  const std::uint64_t lost = journal.bytes_lost();
  {
    const FullDisk full(0);
    journal.tick(at(100));
    EXPECT_FALSE(journal.recording());
    EXPECT_FALSE(journal.take_error()) << "said once";
  }
  EXPECT_EQ(rotated_files(config.directory, "r1.", ".raw").size(), 1U) << "a try leaves nothing behind";
  EXPECT_EQ(journal.bytes_lost(), lost) << "nor does it lose what the file before holds";
  EXPECT_GT(payloads(first, false).size(), 300U);
  journal.tick(at(105));
  EXPECT_FALSE(journal.recording()) << "tried every ten seconds";
  journal.tick(at(110));
  EXPECT_TRUE(journal.recording());
  EXPECT_FALSE(journal.take_resumed()) << "not before bytes are there";
  journal.append({0, RawDirection::received, {}, "again"});
  journal.tick(at(112));
  EXPECT_EQ(journal.take_resumed(), journal.bytes_lost());
  EXPECT_FALSE(journal.take_resumed());
  EXPECT_FALSE(journal.trouble());
  EXPECT_EQ(journal.stops(), 1U);
  EXPECT_NE(journal.file(), first);
  EXPECT_EQ(payloads(journal.file()), "again");
}

/// Room for a header and no more, for an hour: one complaint, and not a file for every try.
TEST(Journal, ADiskThatTakesOnlyAHeaderIsToldOnceAndLeavesNoFiles) {
  TempDir dir;
  const auto config = config_in(dir);
  Journal journal(config, at(0));
  const FullDisk full(header_bytes() + 4);
  int told = 0;
  for (int second = 1; second <= 3600; ++second) {
    journal.append({0, RawDirection::received, {}, "0123456789"});
    journal.tick(at(second));
    if (journal.take_error()) ++told;
    EXPECT_FALSE(journal.take_resumed());
  }
  EXPECT_EQ(told, 1);
  EXPECT_EQ(journal.stops(), 1U);
  EXPECT_LE(rotated_files(config.directory, "r1.", ".raw").size(), 2U);
  EXPECT_GT(journal.bytes_lost(), 3000U * 10);
}

TEST(Journal, HeldItStopsUntilItIsReleased) {
  TempDir dir;
  Journal journal(config_in(dir), at(0));
  journal.append({0, RawDirection::received, {}, "before"});
  journal.hold({ErrorCode::io, "little room", ""});
  EXPECT_EQ(payloads(journal.file()), "before");
  journal.tick(at(60));
  EXPECT_FALSE(journal.recording());
  journal.append({0, RawDirection::received, {}, "lost"});
  journal.release();
  EXPECT_TRUE(journal.recording());
  journal.append({0, RawDirection::received, {}, "after"});
  journal.tick(at(61));
  EXPECT_EQ(journal.take_resumed(), 4U);
}

TEST(Journal, ADirectoryItCannotHaveIsTroubleAndIsTriedAgain) {
  TempDir dir;
  auto config = config_in(dir);
  std::ofstream(dir / "raw") << "a file";
  Journal journal(config, at(0));
  EXPECT_FALSE(journal.recording());
  const auto error = journal.take_error();
  ASSERT_TRUE(error);
  EXPECT_FALSE(error->remedy.empty());
  std::filesystem::remove(dir / "raw");
  journal.tick(at(11));
  EXPECT_TRUE(journal.recording());
}

}  // namespace
}  // namespace mgtd::daemon::store
