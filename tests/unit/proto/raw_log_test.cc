// SPDX-License-Identifier: Apache-2.0
#include "proto/raw_log.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace mgtd {
namespace {

struct Kept {
  std::uint8_t device;
  RawDirection direction;
  std::int64_t mono_ns, wall_ns;
  std::string bytes;
  bool operator==(const Kept&) const = default;
};

std::vector<Kept> drain(RawLogDecoder& decoder) {
  std::vector<Kept> found;
  while (const auto r = decoder.next()) {
    found.push_back({r->device, r->direction, r->at.mono.time_since_epoch().count(), r->at.wall.ns,
                     std::string(r->bytes)});
  }
  return found;
}

std::string sample_log(std::vector<Kept>& kept, int records) {
  std::mt19937_64 random(11);
  std::string log = encode_header({"cross 1", "r1"});
  RawLogEncoder encoder;
  for (int i = 0; i < records; ++i) {
    Kept k{static_cast<std::uint8_t>(random() % 6), static_cast<RawDirection>(random() % 6),
           static_cast<std::int64_t>(random()), -static_cast<std::int64_t>(random() % 1000),
           std::string(random() % 80, '\0')};
    for (char& c : k.bytes) c = static_cast<char>(random());
    if (i % 3 == 2) {  // after any record, at any distance, with and without a step of the wall clock
      k = {kept.back().device, RawDirection::tick, kept.back().mono_ns, kept.back().wall_ns, ""};
      const auto since = static_cast<std::int64_t>(random() % 5'000'000'000);
      k.mono_ns = kept.back().mono_ns / 2 + since;
      k.wall_ns += k.mono_ns - kept.back().mono_ns / 2 + (i % 2 == 0 ? 1'000'000'000 : 0);
      if (i % 4 == 0) k.mono_ns = kept.back().mono_ns + since;
    }
    encoder.encode({k.device, k.direction, {Instant{Duration{k.mono_ns}}, {k.wall_ns}}, k.bytes}, log);
    kept.push_back(k);
  }
  return log;
}

TEST(RawLog, CrcIsThatOfIeee8023) { EXPECT_EQ(crc32("123456789"), 0xCBF43926U); }

TEST(RawLog, ReadsWhatWasWrittenHoweverItIsCut) {
  std::vector<Kept> kept;
  const std::string log = sample_log(kept, 50);
  for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, std::size_t{64}, log.size()}) {
    RawLogDecoder decoder;
    std::vector<Kept> found;
    for (std::size_t at = 0; at < log.size(); at += piece) {
      decoder.feed(std::string_view(log).substr(at, piece));
      for (Kept& k : drain(decoder)) found.push_back(std::move(k));
    }
    EXPECT_EQ(found, kept);
    EXPECT_EQ(decoder.header().rig, "cross 1");
    EXPECT_EQ(decoder.header().run_id, "r1");
    EXPECT_EQ(decoder.good_bytes(), log.size());
    EXPECT_TRUE(decoder.finish());
  }
}

TEST(RawLog, ATornTailCostsTheLastRecordOnly) {
  std::vector<Kept> kept;
  const std::string log = sample_log(kept, 3);
  const std::string head = encode_header({"cross 1", "r1"});
  for (std::size_t size = head.size() + 1; size < log.size(); ++size) {
    RawLogDecoder decoder;
    decoder.feed(std::string_view(log).substr(0, size));
    const auto found = drain(decoder);
    EXPECT_LT(found.size(), 3U);
    EXPECT_TRUE(std::equal(found.begin(), found.end(), kept.begin()));
    EXPECT_EQ(static_cast<bool>(decoder.finish()), decoder.good_bytes() == size) << size;
  }
}

TEST(RawLog, EveryFlippedBitIsSeen) {
  std::vector<Kept> kept;
  const std::string log = sample_log(kept, 4);
  for (std::size_t at = 0; at < log.size(); ++at) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      std::string bad = log;
      bad[at] = static_cast<char>(bad[at] ^ static_cast<char>(1U << bit));
      RawLogDecoder decoder;
      decoder.feed(bad);
      const auto found = drain(decoder);
      EXPECT_LT(found.size(), 4U);
      EXPECT_TRUE(std::equal(found.begin(), found.end(), kept.begin()));
      EXPECT_FALSE(decoder.finish());
    }
  }
}

TEST(RawLog, LongPayloadsAreSplit) {
  std::string log = encode_header({});
  const std::string bytes(2 * kRawRecordMax + 5, 'x');
  RawLogEncoder().encode({1, RawDirection::sent, {}, bytes}, log);
  RawLogDecoder decoder;
  decoder.feed(log);
  const auto found = drain(decoder);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].bytes + found[1].bytes + found[2].bytes, bytes);
}

}  // namespace
}  // namespace mgtd
