// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "proto/reading.h"

/// Four free-running devices for tests of the sampler: crystals off by ppm, phases apart, delivery late by a
/// law of choice. Every axis of every sensor reads kSlope x true time, so that an epoch's readings tell when
/// they were really taken.
namespace mgtd::test {

inline constexpr double kSlope_nT_per_s = 1000.0;

struct DeviceSim {
  double period_s{0.02};
  double ppm{0};
  double phase_s{0};
  std::function<double(double sample_s)> delay_s = [](double) { return 0.0; };
  std::function<bool(std::uint64_t k)> lost = [](std::uint64_t) { return false; };
  bool counts_losses{true};  ///< the driver knows of frames it lost
};

inline Stamp stamp_at(double t_s) {
  return {Instant{from_seconds(100.0 + t_s)},
          WallTime{1'700'000'000'000'000'000 + from_seconds(t_s).count()}};
}
inline double true_time(const Stamp& stamp) { return to_seconds(stamp.mono - Instant{from_seconds(100.0)}); }

/// Readings of one device in order of arrival (a later frame never overtakes an earlier one).
inline std::vector<FieldReading> stream_of(int slot, const DeviceSim& device, double from_s, double to_s) {
  std::vector<FieldReading> readings;
  const double period_s = device.period_s * (1 + device.ppm * 1e-6);
  double last_arrival_s = -1e9;
  std::uint64_t seq = 0;
  for (std::uint64_t k = 0;; ++k) {
    const double t_s = from_s + device.phase_s + static_cast<double>(k) * period_s;
    if (t_s >= to_s) return readings;
    if (device.lost(k)) {
      if (device.counts_losses) ++seq;
      continue;
    }
    last_arrival_s = std::max(last_arrival_s, t_s + device.delay_s(t_s));
    FieldReading r;
    r.slot = slot;
    r.seq = seq++;
    r.arrival = stamp_at(last_arrival_s);
    r.y_nT.setConstant(kSlope_nT_per_s * t_s);
    readings.push_back(r);
  }
}

/// All streams merged by arrival; `order` breaks ties.
inline std::vector<FieldReading> merged(const std::array<DeviceSim, kSensors>& devices, double to_s) {
  std::vector<FieldReading> all;
  for (int slot = 0; slot < kSensors; ++slot) {
    const auto one = stream_of(slot, devices[static_cast<std::size_t>(slot)], 0, to_s);
    all.insert(all.end(), one.begin(), one.end());
  }
  std::stable_sort(all.begin(), all.end(), [](const FieldReading& a, const FieldReading& b) {
    return a.arrival.mono < b.arrival.mono;
  });
  return all;
}

/// Delivered at the next tick of a timer: what a USB serial adapter with a latency timer does.
inline std::function<double(double)> bunched(double tick_s, double phase_s) {
  return [=](double t_s) { return tick_s * std::ceil((t_s + phase_s) / tick_s) - phase_s - t_s; };
}

/// Uniform in [0, most_s), drawn per sample.
inline std::function<double(double)> uniform_delay(double most_s, std::uint64_t seed) {
  return [most_s, random = std::mt19937_64(seed)](double) mutable {
    return std::uniform_real_distribution<double>(0, most_s)(random);
  };
}

}  // namespace mgtd::test
