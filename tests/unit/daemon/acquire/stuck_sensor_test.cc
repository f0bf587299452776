// SPDX-License-Identifier: Apache-2.0
#include "daemon/acquire/stuck_sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace mgtd::daemon::acquire {
namespace {

/// Readings of a sensor with 0.3 nT of noise, rounded to `resolution_nT`.
class Sensor {
 public:
  explicit Sensor(double resolution_nT) : resolution_nT_(resolution_nT) {}
  Eigen::Vector3d operator()() {
    Eigen::Vector3d y;
    for (double& x : y) x = std::round(normal_(random_) / resolution_nT_) * resolution_nT_;
    return y;
  }

 private:
  double resolution_nT_;
  std::mt19937_64 random_{7};
  std::normal_distribution<double> normal_{0, 0.3};
};

TEST(StuckSensor, AFineDigitiserIsCaughtAtTheFirstRepeat) {
  Sensor sensor(0.012);
  StuckSensor watch;
  for (int i = 0; i < 1000; ++i) ASSERT_FALSE(watch.stands_still(sensor()));
  const Eigen::Vector3d stuck = sensor();
  ASSERT_FALSE(watch.stands_still(stuck));
  for (int i = 0; i < 500; ++i) EXPECT_TRUE(watch.stands_still(stuck));
  // It lives again, and what it did is no habit.
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(watch.stands_still(sensor()));
  const Eigen::Vector3d again = sensor();
  static_cast<void>(watch.stands_still(again));
  EXPECT_TRUE(watch.stands_still(again));
}

TEST(StuckSensor, ANewSensorNeedsSomeRepeats) {
  StuckSensor watch;
  int before = 0;
  while (!watch.stands_still(Eigen::Vector3d(1, 2, 3)) && before < 1000) ++before;
  EXPECT_LT(before, 100);
}

TEST(StuckSensor, AResolutionCoarserThanTheNoiseIsNotAccused) {
  Sensor sensor(1.0);  // 90 % of the readings of an axis are zero, 73 % of the triples repeat
  StuckSensor watch;
  int accused = 0;
  for (int i = 0; i < 20'000; ++i) accused += watch.stands_still(sensor()) ? 1 : 0;
  EXPECT_LT(accused, 80);  // one in a thousand, four times over
}

TEST(StuckSensor, OneAxisThatRepeatsIsNoStandstill) {
  Sensor sensor(0.012);
  StuckSensor watch;
  int accused = 0;
  for (int i = 0; i < 5000; ++i) {
    Eigen::Vector3d y = sensor();
    y.x() = 0;
    accused += watch.stands_still(y) ? 1 : 0;
  }
  EXPECT_LE(accused, 1);  // the other two repeat by chance once in 8000 readings, and the first row counts
}

}  // namespace
}  // namespace mgtd::daemon::acquire
