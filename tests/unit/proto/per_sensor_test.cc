// SPDX-License-Identifier: Apache-2.0
#include "proto/per_sensor.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstring>
#include <memory>
#include <new>

namespace mgtd {
namespace {

/// A PerSensor<T> made in memory where every byte was 0xff: doubles that are no numbers.
template <class T, class... Sensors>
PerSensor<T> made_in_used_memory(Sensors... sensors) {
  struct alignas(PerSensor<T>) Memory {
    std::byte bytes[sizeof(PerSensor<T>)];
  } memory;
  std::memset(memory.bytes, 0xff, sizeof memory.bytes);
  auto* const made = new (memory.bytes) PerSensor<T>(sensors...);
  PerSensor<T> copy(*made);
  std::destroy_at(made);
  return copy;
}

TEST(PerSensor, HoldsTheSensorsOfTheCross) { EXPECT_EQ(PerSensor<double>().size(), kSensorCount); }

TEST(PerSensor, BeginsAtZero) {
  for (const double x : made_in_used_memory<double>()) EXPECT_EQ(x, 0);
  for (const Eigen::Vector3d& v : made_in_used_memory<Eigen::Vector3d>()) EXPECT_TRUE(v.isZero(0));
  const auto matrices = made_in_used_memory<Eigen::Matrix3d>(std::size_t{16});
  EXPECT_EQ(matrices.size(), 16U);
  for (const Eigen::Matrix3d& m : matrices) EXPECT_TRUE(m.isZero(0));
}

TEST(PerSensor, HoldsNoMoreThanTheMost) { EXPECT_THROW(PerSensor<double>(std::size_t{17}), std::bad_alloc); }

}  // namespace
}  // namespace mgtd
