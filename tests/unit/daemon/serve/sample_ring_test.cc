// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/sample_ring.h"

#include <gtest/gtest.h>

namespace mgtd::daemon::serve {
namespace {

constexpr std::size_t kSlots = 100, kSample = 700, kStatus = 4000;

std::size_t bytes_held(const SampleRing& ring) {
  std::size_t sum = 0;
  for (std::uint64_t k = ring.begin(); k < ring.end(); ++k) sum += ring.at(k).line.capacity();
  return sum;
}

/// One status among 50 samples, as the daemon sends them: each lap of the ring it meets other slots.
TEST(SampleRing, ALongLineNowAndThenDoesNotMakeItGrow) {
  SampleRing ring(kSlots);
  const std::string sample(kSample, 's'), status(kStatus, 'S');
  for (std::uint64_t seq = 0; seq < 100 * kSlots; ++seq) {
    ring.push_sample(seq, {}, sample);
    if (seq % 50 == 0) ring.push_other(StreamClass::status, status);
  }
  EXPECT_LT(bytes_held(ring), kSlots * kSample * 5 / 4 + 3 * kStatus * 5 / 4);
}

TEST(SampleRing, LinesOfLikeLengthStayWhereTheyAre) {
  SampleRing ring(kSlots);
  for (std::uint64_t seq = 0; seq < kSlots; ++seq) ring.push_sample(seq, {}, std::string(kSample, 's'));
  const char* const before = ring.at(0).line.data();
  ring.push_sample(kSlots, {}, std::string(kSample + 20, 's'));
  EXPECT_EQ(ring.at(kSlots).line.data(), before);
  EXPECT_EQ(ring.at(kSlots).line, std::string(kSample + 20, 's') + '\n');
}

}  // namespace
}  // namespace mgtd::daemon::serve
