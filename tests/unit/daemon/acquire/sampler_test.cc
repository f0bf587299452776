// SPDX-License-Identifier: Apache-2.0
#include "daemon/acquire/sampler.h"

#include <gtest/gtest.h>

#include "tests/unit/daemon/serve/streams.h"

namespace mgtd::daemon {
namespace {

using test::DeviceSim;
using test::kSlope_nT_per_s;
using test::merged;
using test::stamp_at;
using test::true_time;

std::vector<EpochOrGap> run(Sampler& sampler, const std::vector<FieldReading>& readings,
                            double silence_after_s = 0) {
  std::vector<EpochOrGap> out;
  for (const FieldReading& r : readings) sampler.push(r, out);
  if (!readings.empty() && silence_after_s > 0) {
    sampler.advance(readings.back().arrival.mono + from_seconds(silence_after_s), out);
  }
  return out;
}

/// Every number once, in order, from 0.
void expect_tiling(const std::vector<EpochOrGap>& items) {
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

std::vector<Epoch> epochs(const std::vector<EpochOrGap>& items) {
  std::vector<Epoch> found;
  for (const EpochOrGap& item : items) {
    if (const auto* e = std::get_if<Epoch>(&item)) found.push_back(*e);
  }
  return found;
}

/// Those after the start, when not every sensor speaks yet.
std::vector<Gap> gaps(const std::vector<EpochOrGap>& items) {
  std::vector<Gap> found;
  for (const EpochOrGap& item : items) {
    const auto* g = std::get_if<Gap>(&item);
    if (g != nullptr && (g->from_seq > 0 || g->why.find("not measuring yet") == std::string::npos))
      found.push_back(*g);
  }
  return found;
}

/// Largest difference between the times the four readings were really taken at.
double true_skew(const Epoch& epoch) {
  double low = 1e300, high = -1e300;
  for (const auto& y : epoch.y_nT) {
    low = std::min(low, y.x() / kSlope_nT_per_s);
    high = std::max(high, y.x() / kSlope_nT_per_s);
  }
  return high - low;
}

std::array<DeviceSim, kSensors> free_running() {
  std::array<DeviceSim, kSensors> d;
  const std::array<double, kSensors> ppm{50, -50, 17, -33}, phase{0.001, 0.0153, 0.0071, 0.0118};
  for (std::size_t i = 0; i < kSensors; ++i) {
    d[i].ppm = ppm[i];
    d[i].phase_s = phase[i];
  }
  return d;
}

TEST(Sampler, OneEpochPerReferenceSampleWhenNothingIsLate) {
  auto devices = free_running();
  Sampler sampler({});
  const auto items = run(sampler, merged(devices, 20));
  expect_tiling(items);
  const auto found = epochs(items);
  EXPECT_GE(found.size(), 995U);
  for (const Epoch& e : found) {
    EXPECT_LT(true_skew(e), 1e-6);
    EXPECT_NEAR(true_time(e.t), e.y_nT[0].x() / kSlope_nT_per_s, 1e-6);
  }
}

/// The worst of ordinary adapters: delivery on a 16 ms timer of each port's own, 50 ppm between the crystals.
TEST(Sampler, SkewStaysFarBelowDeliveryBunches) {
  auto devices = free_running();
  for (std::size_t i = 0; i < kSensors; ++i) {
    devices[i].delay_s = test::uniform_delay(0.016, 7 + i);
  }
  Sampler sampler({});
  const auto items = run(sampler, merged(devices, 300));
  expect_tiling(items);
  double worst = 0, worst_bound = 0;
  std::size_t beyond = 0;
  for (const Epoch& e : epochs(items)) {
    beyond += true_skew(e) > e.skew_bound_s;
    if (true_time(e.t) < 120) continue;
    worst = std::max(worst, true_skew(e));
    worst_bound = std::max(worst_bound, e.skew_bound_s);
  }
  RecordProperty("worst_skew_us", static_cast<int>(worst * 1e6));
  RecordProperty("worst_bound_us", static_cast<int>(worst_bound * 1e6));
  EXPECT_LT(worst, 50e-6);
  EXPECT_LT(worst_bound, 8e-3);  // where delays of chance end is known to some of the gaps between them
  EXPECT_EQ(beyond, 0U);
}

TEST(Sampler, TimerThatBeatsWithTheSampleRateIsLearntInAWindow) {
  auto devices = free_running();
  for (std::size_t i = 0; i < kSensors; ++i) {
    devices[i].delay_s = test::bunched(0.016, 0.0037 * static_cast<double>(i));
  }
  Sampler sampler({});
  const auto items = run(sampler, merged(devices, 1500));
  double worst = 0;
  for (const Epoch& e : epochs(items)) {
    if (true_time(e.t) > 600) worst = std::max(worst, true_skew(e));
  }
  RecordProperty("worst_skew_us", static_cast<int>(worst * 1e6));
  EXPECT_LT(worst, 1e-3);
}

TEST(Sampler, LostFramesBecomeGapsThatNameTheSensor) {
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
TEST(Sampler, FramesLostUnseenAreFoundByTime) {
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

TEST(Sampler, SilentSensorBecomesGapsAndNeverAStall) {
  for (int silent = 0; silent < kSensors; ++silent) {
    auto devices = free_running();
    devices[static_cast<std::size_t>(silent)].lost = [](std::uint64_t k) { return k >= 250; };
    Sampler sampler({});
    std::vector<EpochOrGap> items;
    double ticked_s = 0;
    for (const FieldReading& r : merged(devices, 15)) {
      sampler.push(r, items);
      for (; ticked_s < true_time(r.arrival); ticked_s += 0.05)
        sampler.advance(stamp_at(ticked_s).mono, items);
    }
    sampler.advance(stamp_at(15.9).mono, items);
    expect_tiling(items);
    EXPECT_NEAR(static_cast<double>(epochs(items).size()), 250, 2);
    ASSERT_FALSE(gaps(items).empty());
    EXPECT_EQ(gaps(items).back().why, "s" + std::to_string(silent + 1) + ": silent");
    EXPECT_LE(gaps(items).size(), 20U);  // a second or so each
    EXPECT_GT(sampler.next_seq(), 740U);
  }
}

TEST(Sampler, SensorThatNeverSpeaksIsCountedToo) {
  Sampler sampler({});
  std::vector<EpochOrGap> items;
  auto devices = free_running();
  devices[0].lost = [](std::uint64_t) { return true; };
  for (const FieldReading& r : merged(devices, 0.1)) sampler.push(r, items);
  sampler.advance(stamp_at(11).mono, items);
  sampler.advance(stamp_at(13).mono, items);
  expect_tiling(items);
  ASSERT_FALSE(gaps(items).empty());
  EXPECT_EQ(gaps(items)[0].why, "s1: silent");
  EXPECT_NEAR(static_cast<double>(sampler.next_seq()), 600, 2);
}

TEST(Sampler, ReopenedDeviceContinuesInTime) {
  for (int slot : {0, 2}) {
    auto devices = free_running();
    const auto i = static_cast<std::size_t>(slot);
    devices[i].lost = [](std::uint64_t k) { return k >= 250; };
    auto readings = merged(devices, 20);
    auto again = test::stream_of(slot, free_running()[i], 10.0037, 20);
    readings.insert(readings.end(), again.begin(), again.end());
    std::stable_sort(readings.begin(), readings.end(),
                     [](const auto& a, const auto& b) { return a.arrival.mono < b.arrival.mono; });
    Sampler sampler({});
    std::vector<EpochOrGap> items;
    bool told = false;
    for (const FieldReading& r : readings) {
      if (!told && true_time(r.arrival) > 10) {
        sampler.reopened(slot);
        told = true;
      }
      sampler.push(r, items);
      sampler.advance(r.arrival.mono, items);
    }
    expect_tiling(items);
    const auto found = epochs(items);
    EXPECT_NEAR(static_cast<double>(found.size()), 750, 4);
    EXPECT_NEAR(static_cast<double>(sampler.next_seq()), 1000, 4);
    EXPECT_TRUE(found[300].flags.has(Flag::clock_unsettled));
    EXPECT_EQ(sampler.health().sensors[i].reopened, 1U);
    for (const Epoch& e : found) EXPECT_LT(true_skew(e), 1e-6);
  }
}

TEST(Sampler, JumpOfADeviceClockIsNotALoss) {
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

TEST(Sampler, DeviceClockFindsLossesTheCountMissed) {
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

TEST(Sampler, StalledHostDeliversEverythingAtOnceAndLosesNothing) {
  auto devices = free_running();
  for (auto& d : devices) {
    d.delay_s = [](double t_s) { return t_s > 8 && t_s < 10.5 ? 10.5 - t_s : 0.0; };
  }
  Sampler sampler({});
  const auto items = run(sampler, merged(devices, 20));
  expect_tiling(items);
  EXPECT_TRUE(gaps(items).empty());
  for (const Epoch& e : epochs(items)) EXPECT_LT(true_skew(e), 1e-6);
}

TEST(Sampler, SuspendedHostStartsNewClocks) {
  auto readings = merged(free_running(), 20);
  for (FieldReading& r :
       readings) {  // five seconds the host's clock did not see; the samples waited in the adapter
    const double t_s = true_time(r.arrival);
    r.arrival = stamp_at(t_s < 5 ? t_s : std::max(5.0, t_s - 5));
  }
  Sampler sampler({});
  const auto items = run(sampler, readings, 3);
  expect_tiling(items);
  EXPECT_GE(sampler.health().sensors[1].clock_breaks, 1U);
  ASSERT_FALSE(gaps(items).empty());
  EXPECT_EQ(gaps(items)[0].why, "s1: clock set back");
  EXPECT_GT(epochs(items).size(), 740U);
  double last = -1;
  for (const Epoch& e : epochs(items)) {
    EXPECT_GT(true_time(e.t), last);
    last = true_time(e.t);
  }
}

TEST(Sampler, TriggeredSensorsAreNotInterpolated) {
  std::array<DeviceSim, kSensors> devices;
  Sampler sampler({});
  const auto items = run(sampler, merged(devices, 10));
  EXPECT_EQ(epochs(items).size(), 500U);
  for (const Epoch& e : epochs(items)) EXPECT_FALSE(e.flags.has(Flag::interpolated));
  for (const Epoch& e : epochs(run(sampler, {}))) EXPECT_FALSE(e.flags.any());
}

TEST(Sampler, FlagsTemperatureAndLatencyReachTheEpoch) {
  auto readings = merged(free_running(), 10);
  for (FieldReading& r : readings) {
    if (r.slot == 1 && r.seq == 300) r.flags |= Flag::saturated;
    if (r.slot == 2) r.arrival.mono += from_seconds(0.25);
  }
  std::stable_sort(readings.begin(), readings.end(),
                   [](const auto& a, const auto& b) { return a.arrival.mono < b.arrival.mono; });
  SamplerConfig config;
  config.latency_s[2] = 0.2;
  config.wire_s[2] = 0.05;
  Sampler sampler(config);
  sampler.push(TemperatureReading{3, stamp_at(0), 21.5, {}, {}});
  const auto found = epochs(run(sampler, readings));
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(
      std::count_if(found.begin(), found.end(), [](const Epoch& e) { return e.flags.has(Flag::saturated); }),
      2);
  EXPECT_EQ(found[100].T_degC[3], 21.5);
  EXPECT_TRUE(std::isnan(found[100].T_degC[0]));
  EXPECT_TRUE(found[20].flags.has(Flag::clock_unsettled));
  EXPECT_FALSE(found[300].flags.has(Flag::clock_unsettled));
  for (const Epoch& e : found) EXPECT_LT(true_skew(e), 1e-6);
}

/// Bytes that waited for ten seconds are dated back by the time that the line needs for them: a sample every
/// 8 ms, each less late than the one before. Nothing was lost.
TEST(Sampler, ABacklogIsNotTakenForALoss) {
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
TEST(Sampler, MiscountedLossesAreCorrectedByTime) {
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
TEST(Sampler, AnOvercountInLateDeliveryCostsSamplesNotTheClock) {
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
TEST(Sampler, ADeviceThatSendsHalfAsOftenStaysInDoubt) {
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
}  // namespace mgtd::daemon
