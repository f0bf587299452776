// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "calib/sensor/channels.h"
#include "proto/epoch.h"
#include "proto/error.h"
#include "proto/pose.h"
#include "proto/time.h"

/// A Dwell makes one row of the pose table from the epochs that were measured while the table stood still.
///
/// mean per axis over the n epochs whose time lies in the dwell; sd of one sample and n_eff such that
///     sd^2 / n_eff = variance of the mean = scatter^2 (1 + 2 sum of autocorrelations) / n
/// on every axis: sd is that of a raw sample even where the sampler's interpolation smoothed the epochs;
/// scalar: mean of the good readings, f_sd = standard uncertainty of that mean; temperatures and auxiliary
/// inputs: means. An epoch with a sensor that repeats itself (Flag::frozen) is no measurement: it counts as
/// missing. What makes a pose unusable is an Error of pose(): too many epochs missing, saturation, a sensor
/// whose value stands still.
namespace mgtd::daemon::run {

constexpr std::size_t kFewestInDwell = 8;  ///< epochs; fewer give no standard deviation worth the name

struct DwellConfig {
  double length_s{5};
  double rate_hz{50};         ///< epochs expected per second
  double max_gap_share{0.2};  ///< of the expected epochs
  double max_saturated_share{0};
  bool frozen_check{true};  ///< off for instruments whose resolution is coarser than their noise
  double scalar_sd_nT{kDefaultScalarSd_nT};  ///< of one scalar reading, until its own scatter says otherwise
  double grace_s{3};                         ///< waited after the end for epochs that come late
};

/// Where and when the dwell is, as the run knows it.
struct DwellPlace {
  int number{0};
  std::string set;
  std::optional<TableAngles> angles;
  Stamp run_start;                 ///< origin of t_s, and its wall time (run_clock.h)
  std::optional<Instant> stopped;  ///< when the table came to rest
  std::optional<int> mount, sense;
};

/// Progress and quality, for the operator.
struct DwellQuality {
  std::size_t epochs{0};
  std::size_t missing{0};  ///< of those expected so far, frozen ones included
  std::size_t frozen{0};
  std::size_t saturated{0};
  /// Successive epochs with all three axes of a sensor exactly equal.
  PerSensor<std::size_t> repeats;
  double gap_share{0};
};

class Dwell {
 public:
  /// Of an array of so many sensors.
  Dwell(DwellConfig config, Instant begin, std::size_t sensors = kSensorCount);

  /// Epochs and readings before begin or after the end are ignored.
  void add(const EpochOrGap& item);
  void add(const ScalarReading& reading);
  void add(const AuxiliaryReading& reading);
  /// The epochs of the whole dwell are in, or will not come (grace_s after its end).
  [[nodiscard]] bool complete(Instant now) const;
  [[nodiscard]] Instant begin() const { return begin_; }
  [[nodiscard]] Instant end() const { return end_; }

  [[nodiscard]] DwellQuality quality() const;
  /// The row, or why there is none (ErrorCode::refused): the pose is to be measured again.
  [[nodiscard]] Result<Pose> pose(const DwellPlace& place) const;

 private:
  using Sample = calib::sensor::FieldVector;
  struct Sum {
    double sum{0};
    std::size_t count{0};
  };
  [[nodiscard]] bool inside(Instant t) const { return t >= begin_ && t < end_; }
  [[nodiscard]] Result<void> acceptable() const;
  [[nodiscard]] double correlation_time(int slot, const std::vector<Sample>& residual) const;
  void fill_readings(Pose& pose) const;
  void fill_scalar(Pose& pose) const;

  DwellConfig config_;
  Instant begin_, end_;
  std::vector<Sample> y_nT_;
  std::vector<std::uint64_t> seq_;
  std::vector<double> f_nT_;
  PerSensor<Sum> T_degC_;
  std::map<std::string, Sum> auxiliary_;  ///< by column
  std::optional<Sample> last_nT_;         ///< of any epoch of the dwell
  PerSensor<std::size_t> repeats_;
  std::size_t heard_{0}, saturated_{0}, frozen_{0};
  bool past_end_{false};
};

}  // namespace mgtd::daemon::run
