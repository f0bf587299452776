// SPDX-License-Identifier: Apache-2.0
// From the epoch to the line of the stream nothing is allocated, whatever the number of sensors. With the
// sanitizers, which have a malloc of their own, the tests are skipped.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "calib/calibration/live_tensor.h"
#include "proto/tensor_encoder.h"
#include "tests/support/counted_malloc.h"

namespace mgtd::calib::calibration {
namespace {

using mgtd::testing::allocations;

/// Sensors on a helix, so that any number of them determines what so many can.
sensor::Geometry helix(std::size_t sensors) {
  PerSensor<Eigen::Vector3d> places_P_m(0);
  for (std::size_t i = 0; i < sensors; ++i) {
    const double turn = static_cast<double>(i);
    places_P_m.push_back({0.2 * std::cos(turn), 0.2 * std::sin(turn), sensors == 1 ? 0 : 0.05 * turn});
  }
  return sensor::Geometry(places_P_m);
}

std::shared_ptr<const Calibration> calibration_of(std::size_t sensors) {
  auto c = std::make_shared<Calibration>();
  const auto n = static_cast<Eigen::Index>(sensors);
  c->geometry = helix(sensors);
  c->sensors = PerSensor<sensor::SensorModel>(sensors);
  c->reference.T_degC = PerSensor<std::optional<double>>(sensors);
  c->sample_noise_nT = c->pose_noise_nT = AxisNoise::Constant(n, 3, 0.3);
  c->covariance = 1e-10 * Eigen::MatrixXd::Identity(12 * n, 12 * n);
  c->seal();
  return c;
}

/// Allocations of so many epochs, two seconds of them before: the line has grown, every cache is filled.
std::size_t allocations_of(LiveTensor& live, std::size_t sensors, int epochs) {
  constexpr int kBefore = 100;
  TensorEncoder encoder;
  Epoch epoch;
  epoch.y_nT = PerSensor<Eigen::Vector3d>(sensors, {20'000, 3'000, 45'000});
  epoch.T_degC = PerSensor<double>(sensors, 23);
  std::size_t before = 0, written = 0;
  for (int k = 0; k < kBefore + epochs; ++k) {
    if (k == kBefore) before = allocations;
    epoch.seq = static_cast<std::uint64_t>(1'000'000 + k);
    epoch.t.mono += std::chrono::milliseconds(20);
    epoch.t.wall.ns = 1'795'255'200'000'000'000 + k * 20'000'000LL;
    epoch.y_nT[0][0] += k % 2 == 0 ? 1.25 : -1.25;
    written += encoder.encode(live.apply(epoch)).size();
  }
  EXPECT_GT(written, 0U);
  return allocations - before;
}

class NoAllocation : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!MGTD_COUNTS_ALLOCATIONS) GTEST_SKIP() << "this build has a malloc of its own";
  }
};

TEST_F(NoAllocation, WhatIsAllocatedIsCounted) {
  const std::size_t before = allocations;
  static const auto something = std::make_unique<double>(1);  // a compiler may leave out a local one
  const Eigen::VectorXd more = Eigen::VectorXd::Constant(100, *something);
  EXPECT_EQ(more[0], 1);
  EXPECT_EQ(allocations, before + 2);
}

TEST_F(NoAllocation, FromTheEpochToTheLineOfTheStream) {
  for (const std::size_t sensors : {1U, 4U, 16U}) {
    LiveTensor raw(helix(sensors)), calibrated(calibration_of(sensors));
    constexpr int kEpochs = 1000;  // twenty seconds, each with a new text of its time
    EXPECT_EQ(allocations_of(raw, sensors, kEpochs), 0U) << sensors;
    EXPECT_EQ(allocations_of(calibrated, sensors, kEpochs), 0U) << sensors;
  }
}

}  // namespace
}  // namespace mgtd::calib::calibration
