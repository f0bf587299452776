// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "daemon/acquire/sampler.h"
#include "tests/unit/daemon/serve/streams.h"

/// These functions feed readings to a sampler and sort what comes out of it.
namespace mgtd::test {

inline std::vector<EpochOrGap> run(daemon::acquire::Sampler& sampler,
                                   const std::vector<FieldReading>& readings, double silence_after_s = 0) {
  std::vector<EpochOrGap> out;
  for (const FieldReading& r : readings) sampler.push(r, out);
  if (!readings.empty() && silence_after_s > 0) {
    sampler.advance(readings.back().arrival.mono + from_seconds(silence_after_s), out);
  }
  return out;
}

/// Every number once, in order, from 0.
inline void expect_tiling(const std::vector<EpochOrGap>& items) {
  std::uint64_t next = 0;
  for (const EpochOrGap& item : items) {
    if (const auto* e = std::get_if<Epoch>(&item)) {
      ASSERT_EQ(e->seq, next);
      ++next;
    } else {
      const Gap& g = std::get<Gap>(item);
      ASSERT_EQ(g.from_seq, next);
      ASSERT_GE(g.to_seq, g.from_seq);
      next = g.to_seq + 1;
    }
  }
}

inline std::vector<Epoch> epochs(const std::vector<EpochOrGap>& items) {
  std::vector<Epoch> found;
  for (const EpochOrGap& item : items) {
    if (const auto* e = std::get_if<Epoch>(&item)) found.push_back(*e);
  }
  return found;
}

/// Those after the start, when not every sensor speaks yet.
inline std::vector<Gap> gaps(const std::vector<EpochOrGap>& items) {
  std::vector<Gap> found;
  for (const EpochOrGap& item : items) {
    const auto* g = std::get_if<Gap>(&item);
    if (g != nullptr && (g->from_seq > 0 || g->why.find("not measuring yet") == std::string::npos))
      found.push_back(*g);
  }
  return found;
}

/// Largest difference between the times the four readings were really taken at.
inline double true_skew(const Epoch& epoch) {
  double low = 1e300, high = -1e300;
  for (const auto& y : epoch.y_nT) {
    low = std::min(low, y.x() / kSlope_nT_per_s);
    high = std::max(high, y.x() / kSlope_nT_per_s);
  }
  return high - low;
}

inline std::array<DeviceSim, kSensors> free_running() {
  std::array<DeviceSim, kSensors> d;
  const PerSensor<double> ppm{50, -50, 17, -33}, phase{0.001, 0.0153, 0.0071, 0.0118};
  for (std::size_t i = 0; i < kSensors; ++i) {
    d[i].ppm = ppm[i];
    d[i].phase_s = phase[i];
  }
  return d;
}

}  // namespace mgtd::test
