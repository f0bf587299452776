// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "calib/sensor/channels.h"
#include "proto/epoch.h"
#include "proto/reading.h"
#include "proto/time.h"

/// FieldBlocks keeps the field in blocks while the table stands: the mean of every axis over half a second,
/// and the readings of the scalar reference. What changes between blocks, beyond their noise, is the field
/// itself.
namespace mgtd::daemon::run {

class FieldBlocks {
 public:
  static constexpr double kBlock_s = 0.5;
  using Axes = calib::sensor::FieldVector;

  /// Of an array of so many sensors.
  FieldBlocks(double rate_hz, Instant begin, std::size_t sensors = kSensorCount);

  /// What was measured before `begin` is ignored.
  void add(const EpochOrGap& item);
  void add(const ScalarReading& reading);

  [[nodiscard]] Instant begin() const { return begin_; }
  /// Complete ones; a block of which more than half is missing counts as none.
  [[nodiscard]] std::size_t blocks() const { return means_nT_.size(); }
  /// Sum over the blocks of the squares of (mean of the block - mean of all), per axis.
  [[nodiscard]] Axes scatter_nT2() const;
  /// Variance of one block's mean if successive samples were independent: from their first differences.
  [[nodiscard]] Axes expected_nT2() const;
  [[nodiscard]] const std::vector<double>& scalar_nT() const { return f_nT_; }

 private:
  void close_block();

  double expected_samples_;
  Instant begin_, block_end_;
  Axes sum_nT_, offset_nT_;
  std::size_t in_block_{0};
  std::vector<Axes> means_nT_;  ///< beside offset_nT_
  std::optional<Axes> last_;
  std::uint64_t last_seq_{0};
  Axes steps_nT2_;
  std::size_t steps_{0};
  std::vector<double> f_nT_;
};

}  // namespace mgtd::daemon::run
