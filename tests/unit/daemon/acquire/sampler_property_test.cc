// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "daemon/acquire/sampler.h"
#include "tests/unit/daemon/serve/streams.h"

namespace mgtd::daemon::acquire {
namespace {

using test::DeviceSim;
using test::stamp_at;
using test::true_time;

constexpr double kDuration_s = 12;
constexpr double kPeriod_s = 0.02;

/// Four devices with whatever can happen to them; readings are noise, so that a value tells which sample it
/// was.
struct World {
  std::vector<FieldReading> readings;
  PerSensor<std::vector<FieldReading>> delivered;
};

World draw_world(bool late, bool losses) {
  World world;
  std::mt19937_64 random(*rc::gen::arbitrary<std::uint64_t>());
  for (int slot = 0; slot < kSensors; ++slot) {
    DeviceSim d;
    d.ppm = *rc::gen::inRange(-100, 101);
    d.phase_s = *rc::gen::inRange(0, 20000) * 1e-6;
    if (late) d.delay_s = test::uniform_delay(*rc::gen::element(0.0, 0.002, 0.016), random());
    const int per_mille = losses ? *rc::gen::element(0, 1, 20, 200) : 0;
    const int silent_from = losses && *rc::gen::inRange(0, 4) == 0 ? *rc::gen::inRange(0, 600) : 1000;
    const int silent_to = silent_from + *rc::gen::inRange(1, 200);
    std::vector<bool> lost;
    for (int k = 0; k < 1000; ++k) {
      lost.push_back(static_cast<int>(random() % 1000) < per_mille || (k >= silent_from && k < silent_to));
    }
    d.lost = [lost](std::uint64_t k) { return k < lost.size() && lost[k]; };
    d.counts_losses = *rc::gen::arbitrary<bool>();
    auto& stream = world.delivered[static_cast<std::size_t>(slot)];
    stream = test::stream_of(slot, d, 0, kDuration_s);
    for (FieldReading& r : stream) {
      std::normal_distribution<double> normal(0, 1);
      r.y_nT = {normal(random), normal(random), normal(random)};
    }
    world.readings.insert(world.readings.end(), stream.begin(), stream.end());
  }
  std::stable_sort(world.readings.begin(), world.readings.end(),
                   [](const auto& a, const auto& b) { return a.arrival.mono < b.arrival.mono; });
  return world;
}

std::vector<EpochOrGap> sampled(const World& world) {
  Sampler sampler({});
  std::vector<EpochOrGap> items;
  double ticked_s = 0;
  for (const FieldReading& r : world.readings) {
    for (; ticked_s < true_time(r.arrival); ticked_s += 0.05) sampler.advance(stamp_at(ticked_s).mono, items);
    sampler.push(r, items);
  }
  sampler.advance(stamp_at(kDuration_s + 3).mono, items);
  sampler.advance(stamp_at(kDuration_s + 5).mono, items);
  return items;
}

/// y lies on the straight line between two readings that were delivered one after the other.
bool is_between_real(const Eigen::Vector3d& y, const std::vector<FieldReading>& stream) {
  for (std::size_t i = 0; i < stream.size(); ++i) {
    if ((y - stream[i].y_nT).norm() < 1e-12) return true;
    if (i == 0) continue;
    const Eigen::Vector3d step = stream[i].y_nT - stream[i - 1].y_nT, from = y - stream[i - 1].y_nT;
    const double f = from.dot(step) / step.squaredNorm();
    if (f >= 0 && f <= 1 && (from - f * step).norm() < 1e-9) return true;
  }
  return false;
}

RC_GTEST_PROP(SamplerProperty, EpochsAndGapsTileTheSequence, ()) {
  std::uint64_t next = 0;
  double last_t_s = -1e9;
  for (const EpochOrGap& item : sampled(draw_world(true, true))) {
    if (const auto* e = std::get_if<Epoch>(&item)) {
      RC_ASSERT(e->seq == next);
      RC_ASSERT(true_time(e->t) > last_t_s);
      RC_ASSERT(e->skew_bound_s >= 0);
      last_t_s = true_time(e->t);
      ++next;
    } else {
      const Gap& g = std::get<Gap>(item);
      RC_ASSERT(g.from_seq == next);
      RC_ASSERT(g.to_seq >= g.from_seq);
      RC_ASSERT(!g.why.empty());
      next = g.to_seq + 1;
    }
  }
  RC_ASSERT(next > 0.9 * kDuration_s / kPeriod_s);
}

RC_GTEST_PROP(SamplerProperty, EveryEpochIsMadeOfRealNeighbours, ()) {
  const World world = draw_world(true, true);
  for (const EpochOrGap& item : sampled(world)) {
    const auto* e = std::get_if<Epoch>(&item);
    for (std::size_t i = 0; e != nullptr && i < kSensors; ++i) {
      RC_ASSERT(is_between_real(e->y_nT[i], world.delivered[i]));
    }
  }
}

/// Without those at the very start and end, where a neighbour may not have been delivered and counting
/// begins. The limits are no whole microseconds, as sample times are.
std::vector<Epoch> inner_epochs(const std::vector<EpochOrGap>& items) {
  std::vector<Epoch> found;
  for (const EpochOrGap& item : items) {
    const auto* e = std::get_if<Epoch>(&item);
    if (e != nullptr && true_time(e->t) > 0.1003337 && true_time(e->t) < kDuration_s - 0.1003337)
      found.push_back(*e);
  }
  return found;
}

/// Which sensor's bytes the host reads first, within the time samples are apart, changes nothing.
RC_GTEST_PROP(SamplerProperty, OrderOfReadingTheFourPortsIsIrrelevant, ()) {
  World world = draw_world(false, false);
  const auto first = sampled(world);
  PerSensor<double> behind{};
  for (double& b : behind) b = *rc::gen::inRange(0, 15) * 1e-3;
  std::stable_sort(world.readings.begin(), world.readings.end(), [&](const auto& a, const auto& b) {
    return true_time(a.arrival) + behind[static_cast<std::size_t>(a.slot)] <
           true_time(b.arrival) + behind[static_cast<std::size_t>(b.slot)];
  });
  const auto second = sampled(world);
  const auto a = inner_epochs(first), b = inner_epochs(second);
  RC_ASSERT(a.size() == b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    RC_ASSERT(std::abs(true_time(a[k].t) - true_time(b[k].t)) < 1e-6);
    // A clock model that is one sample younger may take a sample as it is instead of interpolating over 2 %
    // of a period; neighbours differ by some 6 nT.
    for (std::size_t i = 0; i < kSensors; ++i) RC_ASSERT((a[k].y_nT[i] - b[k].y_nT[i]).norm() < 0.15);
  }
}

}  // namespace
}  // namespace mgtd::daemon::acquire
