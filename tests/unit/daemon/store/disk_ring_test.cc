// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/disk_ring.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "daemon/store/durable_file.h"
#include "proto/stream_codec.h"
#include "tests/unit/daemon/full_disk.h"
#include "tests/unit/daemon/temp_dir.h"

namespace mgtd::daemon::store {
namespace {

using test::FullDisk;
using test::TempDir;
using Kind = RingRecord::Kind;

Stamp at(double s) { return {Instant{from_seconds(s)}, WallTime{from_seconds(1e9 + s).count()}}; }

DiskRingConfig config_in(const TempDir& dir, std::uint64_t bytes = 1U << 20U) {
  return {.directory = dir.path() / "stream", .rig = "cross", .rate_hz = 50, .bytes = bytes};
}

std::string line_of(std::uint64_t seq) { return fmt::format(R"({{"class":"TENSOR","seq":{}}})", seq); }

/// Samples at 50 Hz; `t0_s`: time of number 0.
void push(DiskRing& ring, std::uint64_t from, std::uint64_t to, double t0_s = 0) {
  for (std::uint64_t seq = from; seq <= to; ++seq) {
    const Stamp now = at(t0_s + static_cast<double>(seq) / 50);
    ring.push({Kind::sample, seq, seq, now, line_of(seq)});
    ring.tick(now);
  }
}

struct Read {
  std::vector<std::uint64_t> seqs;  ///< first number of each
  std::vector<std::string> gaps;
};

Read read(DiskRing& ring, std::uint64_t from) {
  Read out;
  RingReader reader = ring.read_from(from);
  while (reader.read([&](const RingRecord& record) {
    out.seqs.push_back(record.from_seq);
    if (record.kind == Kind::gap) out.gaps.emplace_back(record.line);
    if (record.kind == Kind::sample) {
      EXPECT_EQ(record.line, line_of(record.from_seq));
    }
  })) {
  }
  return out;
}

TEST(DiskRing, GivesBackFromAnyNumberHeld) {
  TempDir dir;
  DiskRing ring(config_in(dir), at(0));
  EXPECT_EQ(ring.first_seq(), 0U);
  EXPECT_FALSE(ring.between());
  EXPECT_FALSE(ring.oldest_seq());
  push(ring, 0, 999);
  ring.tick(at(30));
  EXPECT_EQ(ring.oldest_seq(), 0U);
  for (const std::uint64_t from : {0U, 1U, 500U, 999U}) {
    const Read got = read(ring, from);
    ASSERT_EQ(got.seqs.size(), 1000 - from);
    EXPECT_EQ(got.seqs.front(), from);
    EXPECT_EQ(got.seqs.back(), 999U);
  }
  EXPECT_TRUE(read(ring, 1000).seqs.empty());
}

TEST(DiskRing, StaysWithinItsSpaceAndForgetsTheOldest) {
  TempDir dir;
  const auto config = config_in(dir, 1U << 20U);
  DiskRing ring(config, at(0));
  push(ring, 0, 39'999);  // 3 MB
  std::uint64_t total = 0;
  for (const RotatedFile& file : rotated_files(config.directory, "stream", ".ring")) total += file.bytes;
  EXPECT_LE(total, config.bytes);
  EXPECT_GT(total, config.bytes * 3 / 4);
  ASSERT_TRUE(ring.oldest_seq());
  EXPECT_GT(*ring.oldest_seq(), 20'000U);
  ring.tick(at(801));
  const Read got = read(ring, 0);
  EXPECT_EQ(got.seqs.front(), *ring.oldest_seq());
  EXPECT_EQ(got.seqs.size(), 40'000 - *ring.oldest_seq());
}

TEST(DiskRing, AfterAnOrderlyEndNumbersGoOnByTheTimeBetween) {
  TempDir dir;
  {
    DiskRing ring(config_in(dir), at(0));
    push(ring, 0, 99);
  }
  DiskRing ring(config_in(dir), at(1.98 + 10));
  EXPECT_EQ(ring.first_seq(), 600U);
  ASSERT_TRUE(ring.between());
  EXPECT_EQ(ring.between()->from_seq, 100U);
  EXPECT_EQ(ring.between()->to_seq, 599U);
  EXPECT_EQ(ring.between()->why, "the daemon was stopped");
  EXPECT_EQ(read(ring, 0).seqs.size(), 100U);
}

/// The files as they stand in the middle of a life: what a kill leaves.
std::map<std::filesystem::path, std::string> snapshot(const std::filesystem::path& directory) {
  std::map<std::filesystem::path, std::string> out;
  for (const RotatedFile& file : rotated_files(directory, "stream", ".ring"))
    out[file.path] = read_file(file.path).value();
  return out;
}

TEST(DiskRing, AfterAKillAtAnyByteNoNumberComesTwiceAndNothingTornIsRead) {
  TempDir source;
  std::map<std::filesystem::path, std::string> left;
  {
    DiskRing ring(config_in(source), at(0));
    push(ring, 0, 99);
    ring.tick(at(3));
    push(ring, 100, 119);  // seen by clients, not yet written
    left = snapshot(source.path() / "stream");
  }
  ASSERT_EQ(left.size(), 1U);
  const auto& [path, bytes] = *left.begin();
  std::vector<std::uint64_t> counts;
  for (std::size_t size = bytes.size() - 400; size <= bytes.size(); size += 5) {
    TempDir dir;
    std::filesystem::create_directories(dir / "stream");
    std::ofstream(dir / "stream" / path.filename(), std::ios::binary) << bytes.substr(0, size);
    // Back at once, by a clock that was set back: only the promise is to be trusted.
    DiskRing ring(config_in(dir), at(-1000));
    EXPECT_GT(ring.first_seq(), 119U);
    ASSERT_TRUE(ring.between());
    EXPECT_EQ(ring.between()->to_seq + 1, ring.first_seq());
    EXPECT_NE(ring.between()->why.find("without a word"), std::string::npos);
    const auto seqs = read(ring, 0).seqs;
    for (std::size_t i = 0; i < seqs.size(); ++i) EXPECT_EQ(seqs[i], i);
    EXPECT_EQ(ring.between()->from_seq, seqs.size());
    counts.push_back(seqs.size());
  }
  EXPECT_EQ(counts.back(), 100U);
  EXPECT_LT(counts.front(), 97U);
}

TEST(DiskRing, AfterAKillSoonAfterARotationNoNumberComesTwice) {
  TempDir source, dir;
  std::uint64_t seq = 0;
  {
    DiskRing ring(config_in(source), at(0));
    for (const auto first = ring.journal().file(); ring.journal().file() == first; ++seq)
      push(ring, seq, seq);
    push(ring, seq, seq + 59);  // the last of them seen by clients, not yet written
    std::filesystem::create_directories(dir / "stream");
    const auto left = snapshot(source.path() / "stream");
    ASSERT_EQ(left.size(), 2U);
    for (const auto& [path, bytes] : left)
      std::ofstream(dir / "stream" / path.filename(), std::ios::binary) << bytes;
  }
  DiskRing ring(config_in(dir), at(-1000));  // only the promise is to be trusted
  EXPECT_GT(ring.first_seq(), seq + 59);
}

TEST(DiskRing, LivesFollowEachOtherInTheReading) {
  TempDir dir;
  std::uint64_t next = 0;
  for (int life = 0; life < 4; ++life) {
    const double now_s = 20.0 * life;
    DiskRing ring(config_in(dir), at(now_s));
    EXPECT_GE(ring.first_seq(), next);
    if (ring.between()) {
      ring.push(
          {Kind::gap, ring.between()->from_seq, ring.between()->to_seq, at(now_s), encode(*ring.between())});
    }
    push(ring, ring.first_seq(), ring.first_seq() + 49, now_s - static_cast<double>(ring.first_seq()) / 50);
    next = ring.first_seq() + 50;
  }
  DiskRing ring(config_in(dir), at(80));
  RingReader reader = ring.read_from(0);
  std::uint64_t expected = 0, gaps = 0;
  while (reader.read([&](const RingRecord& record) {
    EXPECT_EQ(record.from_seq, expected);
    expected = record.to_seq + 1;
    gaps += record.kind == Kind::gap ? 1 : 0;
  })) {
  }
  EXPECT_EQ(expected, next);
  EXPECT_EQ(gaps, 3U);
}

TEST(DiskRing, FullDiskCostsSamplesButNoNumbers) {
  TempDir dir;
  std::uint64_t lost_to = 0;
  {
    DiskRing ring(config_in(dir), at(0));
    push(ring, 0, 49);
    ring.tick(at(1.5));
    {
      const FullDisk full(1000);
      push(ring, 50, 149);
      EXPECT_FALSE(ring.journal().recording());
    }
    ring.tick(at(20));
    EXPECT_TRUE(ring.journal().recording());
    push(ring, 150, 199);
    ring.tick(at(21));
    const Read got = read(ring, 0);
    EXPECT_EQ(got.seqs.back(), 199U);
    lost_to = got.seqs.size();
    EXPECT_LT(lost_to, 150U);
  }
  DiskRing ring(config_in(dir), at(0));
  EXPECT_EQ(ring.first_seq(), 200U);
}

TEST(DiskRing, WithoutADirectoryItCountsOnAndSaysWhy) {
  TempDir dir;
  std::ofstream(dir / "stream") << "a file";
  DiskRing ring(config_in(dir), at(0));
  push(ring, 0, 10);
  EXPECT_TRUE(ring.journal().trouble());
  EXPECT_FALSE(ring.oldest_seq());
  EXPECT_TRUE(read(ring, 0).seqs.empty());
}

}  // namespace
}  // namespace mgtd::daemon::store
