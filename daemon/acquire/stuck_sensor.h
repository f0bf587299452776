// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>

/// StuckSensor decides whether a sensor still measures or repeats its last reading again and again.
///
/// Noise makes readings differ: that all three axes repeat to the last bit is rare, how rare depends on
/// resolution against noise and is learnt from the stream itself. With p the share of readings that begin a
/// row of repeats and q that of repeats that are followed by another, r repeats in a row are taken for a
/// standstill when p q^(r-1) < 1e-3, and the first row of all. A fine digitiser is caught at the first
/// repeat; one coarser than its noise needs more and is not accused wrongly. What has only ever said one
/// thing is not known to measure. Pure.
namespace mgtd::daemon::acquire {

class StuckSensor {
 public:
  /// The next reading, nT: whether the sensor stands still, this reading included.
  [[nodiscard]] bool stands_still(const Eigen::Vector3d& y_nT);

 private:
  Eigen::Vector3d last_nT_{Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())};
  std::uint64_t readings_{0}, rows_{0}, continued_{0};  ///< of a sensor that measures
  std::uint64_t row_{0};                                ///< repeats since the last reading that was new
};

}  // namespace mgtd::daemon::acquire
