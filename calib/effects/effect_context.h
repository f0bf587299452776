// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "proto/pose.h"

/// An EffectContext holds what an effect may need to know of the run, beyond the pose it is evaluated at.
namespace mgtd::calib::effects {
namespace laws {
struct RunMemory;
}

inline constexpr double kReferenceT_degC = 20;        ///< T0 of every effect of temperature
inline constexpr double kReferenceField_nT = 50'000;  ///< F0: x = v/F0

struct EffectContext {
  const PoseTable* table{nullptr};  ///< every pose in the order it was measured, those of set "check" too
  /// Offsets of the axes where they are known (a calibration); else they are estimated from the readings.
  std::optional<PerSensor<Eigen::Vector3d>> offset_nT;
  /// run_memory() of the two above, for those who bind many effects to one run; else each makes its own.
  std::shared_ptr<const laws::RunMemory> memory{};

  [[nodiscard]] int sensors() const {
    if (offset_nT) return static_cast<int>(offset_nT->size());
    return table == nullptr || table->poses.empty() ? kSensors
                                                    : static_cast<int>(table->poses.front().y_nT.size());
  }
};

}  // namespace mgtd::calib::effects
