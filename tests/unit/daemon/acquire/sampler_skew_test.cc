// SPDX-License-Identifier: Apache-2.0
// How well four free-running sensors are brought to one time, on a platform that turns.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "daemon/acquire/sampler.h"
#include "tests/unit/daemon/serve/streams.h"

namespace mgtd::daemon::acquire {
namespace {

using test::DeviceSim;
using test::true_time;

constexpr double kTurn_rad_per_s = 10 * std::numbers::pi / 180;
constexpr double kField_nT = 50'000;
constexpr double kPorts = 4;

/// Crystals 50 ppm apart and more, phases of their own; `delay(i)` the delivery of sensor i.
template <class Delay>
std::vector<FieldReading> turning(double to_s, const Delay& delay) {
  constexpr std::array<double, kSensors> kPpm{50, -50, 17, -33}, kPhase_s{0.001, 0.0153, 0.0071, 0.0118};
  std::array<DeviceSim, kSensors> devices;
  for (std::size_t i = 0; i < kSensors; ++i) {
    devices.at(i).ppm = kPpm.at(i);
    devices.at(i).phase_s = kPhase_s.at(i);
    devices.at(i).delay_s = delay(i);
  }
  auto readings = test::merged(devices, to_s);
  for (FieldReading& r : readings) {
    const double angle_rad = kTurn_rad_per_s * r.y_nT.x() / test::kSlope_nT_per_s;
    r.y_nT = kField_nT * Eigen::Vector3d(std::cos(angle_rad), std::sin(angle_rad), 0);
  }
  return readings;
}

struct Skew {
  double rms_s{0};          ///< of the four about their mean, epochs after from_s
  double bound_held{0};     ///< share of all epochs
  double worst_bound_s{0};  ///< after from_s
};

Skew skew_of(const std::vector<FieldReading>& readings, double from_s) {
  Sampler sampler({});
  std::vector<EpochOrGap> items;
  for (const FieldReading& r : readings) sampler.push(r, items);
  Skew out;
  double squares = 0, count = 0, held = 0, epochs = 0;
  for (const EpochOrGap& item : items) {
    const auto* e = std::get_if<Epoch>(&item);
    if (e == nullptr) continue;
    Eigen::Vector4d t_s;
    for (int i = 0; i < kSensors; ++i) {
      const auto &y = e->y_nT.at(static_cast<std::size_t>(i)), &first = e->y_nT[0];
      t_s[i] = std::atan2(first.x() * y.y() - first.y() * y.x(), first.dot(y)) / kTurn_rad_per_s;
    }
    ++epochs;
    held += t_s.maxCoeff() - t_s.minCoeff() <= e->skew_bound_s + 1e-7 ? 1 : 0;
    if (true_time(e->t) < from_s) continue;
    squares += (t_s.array() - t_s.mean()).square().sum();
    count += kPorts;
    out.worst_bound_s = std::max(out.worst_bound_s, e->skew_bound_s);
  }
  out.rms_s = std::sqrt(squares / count);
  out.bound_held = held / epochs;
  return out;
}

/// Each port delivers within 16 ms, as the host gets to it: half a minute tells the clocks.
TEST(SamplerSkew, BunchesOfChanceAreLearntInHalfAMinute) {
  const auto delay = [](std::size_t i) { return test::uniform_delay(0.016, 7 + i); };
  const Skew skew = skew_of(turning(300, delay), 30);
  RecordProperty("rms_us", static_cast<int>(skew.rms_s * 1e6));
  EXPECT_LT(skew.rms_s, 50e-6);
  EXPECT_GT(skew.bound_held, 0.99);
  EXPECT_LT(skew.worst_bound_s, 8e-3);  // it cannot tell them from delays without an end
}

/// Each port delivers on a 16 ms timer that beats with the samples: 4 ms of every delay hide for up to 235 s,
/// the length of a beat at 17 ppm. The bound knows.
TEST(SamplerSkew, ATimerThatBeatsIsLearntInFiveMinutes) {
  const auto delay = [](std::size_t i) { return test::bunched(0.016, 0.0037 * static_cast<double>(i)); };
  const Skew skew = skew_of(turning(900, delay), 300);
  RecordProperty("rms_us", static_cast<int>(skew.rms_s * 1e6));
  EXPECT_LT(skew.rms_s, 50e-6);
  EXPECT_GT(skew.bound_held, 0.99);
}

}  // namespace
}  // namespace mgtd::daemon::acquire
