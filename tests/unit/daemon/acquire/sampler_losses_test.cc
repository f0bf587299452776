// SPDX-License-Identifier: Apache-2.0
// Samples that are lost, miscounted or late: every number of the stream is there once, as an epoch or in a
// gap that says why, and the clocks of the sensors stay.
#include <gtest/gtest.h>

#include <cmath>

#include "daemon/acquire/sampler.h"
#include "tests/unit/daemon/acquire/sampler_runs.h"

namespace mgtd::daemon::acquire {
namespace {

using test::DeviceSim;
using test::epochs;
using test::expect_tiling;
using test::free_running;
using test::gaps;
using test::kSlope_nT_per_s;
using test::merged;
using test::run;
using test::true_skew;
using test::true_time;

TEST(SamplerLosses, LostFramesBecomeGapsThatNameTheSensor) {
  auto devices = free_running();
  devices[1].lost = [](std::uint64_t k) { return k == 200; };
  devices[0].lost = [](std::uint64_t k) { return k >= 300 && k < 305; };
  Sampler sampler({});
  const auto items = run(sampler, merged(devices, 10));
  expect_tiling(items);
  const auto found = gaps(items);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].why, "s2: frame lost");
  EXPECT_EQ(found[0].to_seq - found[0].from_seq + 1, 2U);  // either side of the lost sample
  EXPECT_EQ(found[1].why, "s1: frame lost");
  EXPECT_EQ(found[1].to_seq - found[1].from_seq + 1, 5U);
  for (const Epoch& e : epochs(items)) EXPECT_LT(true_skew(e), 1e-6);
  EXPECT_EQ(sampler.health().sensors[0].lost, 5U);
  EXPECT_EQ(sampler.health().sensors[1].gaps, 2U);
}

/// A frame that vanished before the driver saw it leaves the count as it was; only time tells.
TEST(SamplerLosses, FramesLostUnseenAreFoundByTime) {
  auto devices = free_running();
  devices[2].lost = [](std::uint64_t k) { return k == 500; };
  devices[2].counts_losses = false;
  Sampler sampler({});
  const auto items = run(sampler, merged(devices, 20));
  expect_tiling(items);
  EXPECT_EQ(sampler.health().sensors[2].lost, 1U);
  std::size_t wrong_unflagged = 0;
  for (const Epoch& e : epochs(items)) {
    EXPECT_TRUE(true_skew(e) < 1e-6 || true_time(e.t) < 11);
    wrong_unflagged += true_skew(e) > e.skew_bound_s + 1e-6 && !e.flags.has(Flag::clock_unsettled);
  }
  EXPECT_EQ(wrong_unflagged, 0U);
}

TEST(SamplerLosses, JumpOfADeviceClockIsNotALoss) {
  auto devices = free_running();
  auto readings = merged(devices, 20);
  for (FieldReading& r : readings) {
    if (r.slot != 3) continue;
    const double t_s = r.y_nT.x() / kSlope_nT_per_s;
    r.device_time_s = 1e9 + std::round(t_s * 1000) / 1000 + (t_s > 10 ? 3.0 : 0.0);  // a leap jump
  }
  Sampler sampler({});
  const auto items = run(sampler, readings);
  EXPECT_TRUE(gaps(items).empty());
  EXPECT_EQ(sampler.health().sensors[3].lost, 0U);
}

TEST(SamplerLosses, DeviceClockFindsLossesTheCountMissed) {
  auto devices = free_running();
  devices[3].lost = [](std::uint64_t k) { return k >= 400 && k < 403; };
  devices[3].counts_losses = false;
  auto readings = merged(devices, 20);
  for (FieldReading& r : readings) {
    if (r.slot == 3) r.device_time_s = std::round(r.y_nT.x() / kSlope_nT_per_s * 1000) / 1000;
  }
  Sampler sampler({});
  const auto items = run(sampler, readings);
  EXPECT_EQ(sampler.health().sensors[3].lost, 3U);
  for (const Epoch& e : epochs(items)) EXPECT_LT(true_skew(e), 1e-6);
}

/// Bytes that waited for ten seconds are dated back by the time that the line needs for them: a sample every
/// 8 ms, each less late than the one before. Nothing was lost.
TEST(SamplerLosses, ABacklogIsNotTakenForALoss) {
  constexpr double kFrom_s = 30, kTo_s = 40, kLine_s = 0.008;
  auto devices = free_running();
  for (DeviceSim& device : devices) {
    device.delay_s = [](double t_s) {
      const double behind_s = (kTo_s - t_s) * (1 - kLine_s / 0.02);
      return t_s > kFrom_s && t_s < kTo_s ? behind_s : 0.0;
    };
  }
  Sampler sampler({});
  const auto items = run(sampler, merged(devices, 60));
  expect_tiling(items);
  for (std::size_t i = 0; i < kSensors; ++i) EXPECT_EQ(sampler.health().sensors.at(i).lost, 0U);
  for (const Epoch& e : epochs(items)) EXPECT_LE(true_skew(e), e.skew_bound_s + 1e-7) << true_time(e.t);
  EXPECT_GT(epochs(items).size(), 2900U);
}

/// A torn line swallowed its neighbour: the driver counted one loss where there were two. Or garbage looked
/// like three lines.
TEST(SamplerLosses, MiscountedLossesAreCorrectedByTime) {
  for (const int miscount : {-1, 2}) {
    auto devices = free_running();
    for (std::size_t i = 0; i < kSensors; ++i) devices[i].delay_s = test::uniform_delay(0.002, i);
    devices[1].lost = [](std::uint64_t k) { return k == 500 || k == 501; };
    auto readings = merged(devices, 20);
    for (FieldReading& r : readings) {
      if (r.slot == 1 && r.seq > 501) r.seq = static_cast<std::uint64_t>(static_cast<int>(r.seq) + miscount);
    }
    Sampler sampler({});
    const auto items = run(sampler, readings);
    expect_tiling(items);
    EXPECT_EQ(sampler.health().sensors[1].lost, 2U);
    EXPECT_EQ(sampler.health().sensors[1].clock_breaks, 0U);
    for (const Epoch& e : epochs(items)) EXPECT_TRUE(true_skew(e) < 1e-3 || true_time(e.t) < 5);
    ASSERT_EQ(gaps(items).size(), 1U);
    EXPECT_EQ(gaps(items)[0].to_seq - gaps(items)[0].from_seq + 1, 3U);
  }
}

/// With delivery as late as samples are apart the miscount shows only later; the numbers come right and the
/// clock stays.
TEST(SamplerLosses, AnOvercountInLateDeliveryCostsSamplesNotTheClock) {
  auto devices = free_running();
  for (std::size_t i = 0; i < kSensors; ++i) devices[i].delay_s = test::uniform_delay(0.016, 40 + i);
  auto readings = merged(devices, 60);
  for (FieldReading& r : readings) {
    if (r.slot == 1 && r.seq > 500) r.seq += 2;
  }
  Sampler sampler({});
  const auto items = run(sampler, readings);
  expect_tiling(items);
  EXPECT_EQ(sampler.health().sensors[1].clock_breaks, 0U);
  for (const Epoch& e : epochs(items))
    EXPECT_TRUE(true_skew(e) < 1e-3 || true_time(e.t) < 13) << true_time(e.t);
}

/// Each of its samples comes later than the one before; that is no proof of a count that is wrong as well.
TEST(SamplerLosses, ADeviceThatSendsHalfAsOftenStaysInDoubt) {
  auto devices = free_running();
  for (std::size_t i = 0; i < kSensors; ++i) devices[i].delay_s = test::uniform_delay(0.002, i);
  std::vector<FieldReading> readings;
  for (FieldReading& r : merged(devices, 30)) {
    if (r.slot == 1 && r.seq > 1000) {
      if (r.seq % 2 == 1) continue;
      const std::uint64_t sent = (r.seq - 1000) / 2;
      r.seq = 1000 + sent + sent / 20;  // a line in twenty is damaged so that it counts as two
    }
    readings.push_back(r);
  }
  Sampler sampler({});
  std::vector<EpochOrGap> items;
  for (const FieldReading& r : readings) {
    sampler.push(r, items);
    sampler.advance(r.arrival.mono, items);
  }
  expect_tiling(items);
  int doubted = 0, late = 0;
  for (const Epoch& e : epochs(items)) {
    EXPECT_LT(true_skew(e), e.skew_bound_s + 1e-4) << true_time(e.t);
    late += true_time(e.t) > 21;
    doubted += true_time(e.t) > 21 && e.flags.has(Flag::clock_unsettled);
  }
  EXPECT_GT(late, 20);
  EXPECT_EQ(doubted, late);
}

}  // namespace
}  // namespace mgtd::daemon::acquire
