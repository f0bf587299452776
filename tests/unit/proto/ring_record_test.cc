// SPDX-License-Identifier: Apache-2.0
#include "proto/ring_record.h"

#include <gtest/gtest.h>

namespace mgtd {
namespace {

using Kind = RingRecord::Kind;

Stamp at(double s) { return {Instant{from_seconds(s)}, WallTime{from_seconds(1000 + s).count()}}; }

RingRecord sample(std::uint64_t seq, double s) { return {Kind::sample, seq, seq, at(s), "{}"}; }

TEST(RingRecord, GoesIntoTheFrameAndBack) {
  const RingRecord gap{Kind::gap, 5, 0x1234567890, at(3), R"({"class":"GAP"})"};
  std::string bytes;
  encode_ring_bytes(gap, bytes);
  const auto back = ring_record(frame(gap, bytes));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->kind, gap.kind);
  EXPECT_EQ(back->from_seq, gap.from_seq);
  EXPECT_EQ(back->to_seq, gap.to_seq);
  EXPECT_EQ(back->at.wall, gap.at.wall);
  EXPECT_EQ(back->line, gap.line);
}

TEST(RingRecord, WhatIsNoneIsSeen) {
  std::string bytes;
  encode_ring_bytes(sample(1, 0), bytes);
  RawRecord record = frame(sample(1, 0), bytes);
  record.device = 9;
  EXPECT_FALSE(ring_record(record));
  record = frame(sample(1, 0), std::string_view(bytes).substr(0, 15));
  EXPECT_FALSE(ring_record(record));
  record = frame(sample(1, 0), bytes);
  record.direction = RawDirection::received;
  EXPECT_FALSE(ring_record(record));
  std::string backwards;
  encode_ring_bytes({Kind::gap, 7, 6, {}, ""}, backwards);
  EXPECT_FALSE(ring_record(frame({Kind::gap, 7, 6, {}, ""}, backwards)));
}

TEST(RingHistory, NumbersGoOnAsTimeDoes) {
  RingHistory history;
  EXPECT_EQ(history.next_seq(at(0).wall, 50), 0U);
  history.add(sample(99, 10));
  EXPECT_EQ(history.end_seq(), 100U);
  EXPECT_EQ(history.next_seq(at(10).wall, 50), 100U);
  EXPECT_EQ(history.next_seq(at(13).wall, 50), 250U);
}

TEST(RingHistory, AClockThatIsWrongLeadsToNoNumberTwice) {
  RingHistory history;
  history.add({Kind::promise, 1500, 1500, at(0), ""});
  history.add(sample(99, 2));
  EXPECT_EQ(history.next_seq(at(-500).wall, 50), 1500U) << "samples up to 1499 may have been seen";
  history.add({Kind::closed, 120, 120, at(3), ""});
  EXPECT_TRUE(history.closed());
  EXPECT_EQ(history.next_seq(at(-500).wall, 50), 120U) << "the last was told";
  EXPECT_LT(history.next_seq(WallTime{INT64_MAX}, 50), 1ULL << 40U);
}

}  // namespace
}  // namespace mgtd
