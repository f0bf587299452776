// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "calib/sensor/channels.h"
#include "drivers/device.h"
#include "proto/epoch.h"
#include "proto/health.h"
#include "proto/reading.h"
#include "proto/run_status.h"
#include "proto/time.h"
#include "proto/units.h"

/// The preflight looks for a few seconds at everything that a run needs. Each check says what was measured,
/// the limit, and what to do when it fails.
///
/// Noise of one sample, per axis, from first differences: sd = sqrt(mean (y[k+1] - y[k])^2 / 2), which no
/// drift and no slow disturbance enters; the total scatter against it shows those. Sensors that are turned or
/// mirrored against the others are named as far as one attitude shows it, and refused for nothing: they may
/// be meant so, and the fit finds every mounting (wiring.h).
namespace mgtd::daemon::run {

struct PreflightConfig {
  double length_s{5};
  double wait_s{20};  ///< for the first reading of an instrument that has sent none yet
  double rate_hz{50};
  double max_rate_error{0.02};  ///< relative
  double max_gap_share{0.05};
  double max_noise_nT{30};      ///< of one sample
  double max_scatter_ratio{6};  ///< total scatter against noise ...
  double scatter_floor_nT{5};   ///< ... not counted below this
  bool frozen_check{true};      ///< off for instruments whose resolution is coarser than their noise
  double max_skew_s{0.04};
  double max_field_error{0.25};      ///< |y| of a sensor not calibrated yet against the field, relative
  std::optional<double> field_nT{};  ///< of the site, used when there is no scalar reference
  bool scalar{false};                ///< a scalar reference is configured
  double max_scalar_sd_nT{10};
};

class Preflight {
 public:
  /// Of an array of so many sensors.
  Preflight(PreflightConfig config, Instant begin, std::size_t sensors = kSensorCount)
      : config_(config), begin_(begin), sensors_(static_cast<int>(sensors)) {}

  void add(const EpochOrGap& item);
  void add(const ScalarReading& reading);
  void add(const TableReading& reading);
  void add(const std::string& device, const LinkHealth& health) { links_[device] = health; }
  /// To be called at every event. A long time between two of them means that this program was not served by
  /// the computer, and readings that are missing say nothing of the cables.
  void passes(Instant now);

  /// length_s after the first epoch (gaps count) when every instrument was heard, else after wait_s.
  [[nodiscard]] bool complete(Instant now) const;
  [[nodiscard]] std::vector<Check> checks(const drivers::TableLimits& limits) const;
  /// Of one sample, the largest axis; 0 when there were too few epochs.
  [[nodiscard]] double noise_nT() const;

 private:
  using Sample = calib::sensor::FieldVector;
  struct Statistics {
    explicit Statistics(Eigen::Index axes)
        : mean_nT(Sample::Zero(axes)), noise_nT(mean_nT), scatter_nT(mean_nT), changes(mean_nT) {}
    Sample mean_nT, noise_nT, scatter_nT;
    Sample changes;  ///< successive values that differ
    std::size_t pairs{0};
  };
  [[nodiscard]] Statistics statistics() const;
  [[nodiscard]] std::optional<double> expected_field_nT() const;
  [[nodiscard]] std::vector<double> good_field_nT() const;
  [[nodiscard]] Check rate() const;
  [[nodiscard]] Check gaps() const;
  [[nodiscard]] Check saturation() const;
  [[nodiscard]] Check skew() const;
  [[nodiscard]] Check wiring(const Statistics& s) const;
  [[nodiscard]] Check noise(int slot, const Statistics& s) const;
  [[nodiscard]] Check scatter(int slot, const Statistics& s) const;
  [[nodiscard]] Check alive(int slot, const Statistics& s) const;
  [[nodiscard]] Check field(int slot, const Statistics& s) const;
  [[nodiscard]] Check scalar() const;
  [[nodiscard]] Check table(const drivers::TableLimits& limits) const;
  /// `otherwise`, unless the program itself stood still: then that comes first.
  [[nodiscard]] std::string remedy(std::string otherwise) const;

  PreflightConfig config_;
  Instant begin_;
  int sensors_;
  std::optional<Instant> first_;
  std::vector<Sample> y_nT_;
  std::vector<std::uint64_t> seq_;
  std::uint64_t missing_{0};
  std::string why_missing_;
  std::size_t saturated_{0};
  double skew_s_{0};
  std::optional<Instant> last_;
  std::vector<ScalarReading> scalar_;
  std::optional<TableReading> table_;
  std::map<std::string, LinkHealth> links_;
  std::optional<Instant> last_event_;
  Duration longest_standstill_{0};     ///< of this program
  Duration listened_to_the_table_{0};  ///< since its last position, standstills of this program left out
};

[[nodiscard]] bool all_passed(const std::vector<Check>& checks);

}  // namespace mgtd::daemon::run
