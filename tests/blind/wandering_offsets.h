// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <random>
#include <vector>

#include "tests/blind/hidden_run.h"

namespace mgtd::calib::testing {

/// These offsets walk at random: a step of `step_nT` (standard deviation) from one pose to the next, each
/// axis by itself.
struct WanderingOffsets {
  double step_nT{0.1};
  int sensor{-1};  ///< 0-based; -1: all four
};

/// Poses are taken in the order of their numbers, up to a thousand.
inline Hidden wandering_offsets(const WanderingOffsets& walk, std::uint64_t seed) {
  std::mt19937_64 rng(seed ^ 0x5851f42d4c957f2dU);
  std::normal_distribution<double> normal;
  auto at = std::make_shared<std::vector<std::array<double, 12>>>();
  std::array<double, 12> now{};
  for (int k = 0; k < 1000; ++k) {
    at->push_back(now);
    for (double& x : now) x += walk.step_nT * normal(rng);
  }
  return [at, walk](const Pose& pose, int sensor, int axis, const Eigen::Vector3d&) {
    if (walk.sensor >= 0 && sensor != walk.sensor) return 0.0;
    return (*at)[static_cast<std::size_t>(pose.number)][static_cast<std::size_t>(3 * sensor + axis)];
  };
}

}  // namespace mgtd::calib::testing
