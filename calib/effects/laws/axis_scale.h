// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "calib/effects/effect.h"
#include "calib/effects/where.h"

/// An AxisScale lays the coefficients of an effect of the axes over one axis, one sensor, or all.
namespace mgtd::calib::effects::laws {

/// What one axis has of a law.
struct AxisCoefficients {
  /// Name of each coefficient of axis a, appended to the place: "" or ".squares"; for a law that couples axes
  /// it depends on the axis ("x" of "s3.zx").
  std::array<std::vector<std::string>, 3> suffix;
  std::string unit;
  double typical{1};
  /// Whether the three axes of a sensor can have a coefficient in common.
  bool axes_alike{true};
};

/// Coefficients in the order s1.x, s1.y, ... at the finest scale; each coefficient of a coarser scale acts
/// where several of the finest do, so that its column is their sum.
class AxisScale {
 public:
  AxisScale(const AxisCoefficients& law, const Where& where);

  [[nodiscard]] const std::vector<Coefficient>& coefficients() const { return coefficients_; }
  [[nodiscard]] std::span<const int> at(int sensor) const { return at_[static_cast<std::size_t>(sensor)]; }
  /// Where the coefficients of this axis begin among those at its sensor; -1: none act on it.
  [[nodiscard]] int first(int sensor, int axis) const {
    return first_[static_cast<std::size_t>(sensor)][static_cast<std::size_t>(axis)];
  }
  [[nodiscard]] int sensors() const { return static_cast<int>(at_.size()); }
  [[nodiscard]] bool acts_on(int sensor) const { return !at(sensor).empty(); }

 private:
  std::vector<Coefficient> coefficients_;
  PerSensor<std::vector<int>> at_;
  PerSensor<std::array<int, 3>> first_;
};

}  // namespace mgtd::calib::effects::laws
