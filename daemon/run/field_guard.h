// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>

#include "daemon/run/field_blocks.h"
#include "daemon/run/field_disturbance.h"

/// A FieldGuard watches the field while the table stands: does it change during a dwell (FieldDisturbance),
/// is it at another level than at the pose before, and has it been calm for long enough to go on? Time comes
/// in.
namespace mgtd::daemon::run {

struct FieldGuardConfig {
  DisturbanceLimits limits;
  double step_nT{5};   ///< of the scalar reference from one pose to the next; 0: not looked at
  double calm_s{5};    ///< without a disturbance, and it is over
  double rate_hz{50};  ///< of the epochs
  std::size_t sensors{kSensorCount};
  double scalar_sd_nT{0};  ///< of one reading, until its own scatter says otherwise
};

class FieldGuard {
 public:
  FieldGuard(const FieldGuardConfig& config, Instant now);

  /// The table stands, or the field is looked at anew: what was measured before does not count.
  void watch(Instant from);
  void add(const EpochOrGap& item) { blocks_.add(item); }
  void add(const ScalarReading& reading) { blocks_.add(reading); }

  /// What was watched is the noise of a field at rest: the preflight first, then every good dwell.
  void begin_noise() { noise_.begin(blocks_); }
  void add_to_noise() { noise_.add(blocks_); }

  /// Judged once for every block; `length_s`: of all that will be judged together.
  [[nodiscard]] std::optional<FieldDisturbance> disturbed(double length_s);
  /// As the last of these looks saw it; empty since watch().
  [[nodiscard]] const std::optional<FieldChange>& change() const { return change_; }
  /// What came while the table moved, and stands there now, is not seen within a dwell.
  [[nodiscard]] std::optional<FieldDisturbance> at_another_level(std::optional<double> f_nT) const;

  /// The dwell under way was given up at `now`, for the first time at this pose or once more.
  void given_up(Instant now);
  /// For so long this pose has been waiting for a calm field, s.
  [[nodiscard]] double waited_s(Instant now) const;
  enum class Calm { not_yet, disturbed, yes };
  [[nodiscard]] Calm calm();

  /// A pose was stored, with this reading of the scalar reference.
  void stored(std::optional<double> f_nT);
  /// An operator who resumes takes the field as it is.
  void paused();

 private:
  [[nodiscard]] std::optional<double> mean_nT() const;

  FieldGuardConfig config_;
  FieldBlocks blocks_;     ///< since watch()
  std::size_t judged_{0};  ///< blocks
  std::optional<FieldChange> change_;
  FieldNoise noise_;
  std::optional<double> level_nT_;  ///< of the scalar reference at the last good pose
  std::optional<Instant> since_;    ///< this pose is disturbed, by whatever comes and goes
};

}  // namespace mgtd::daemon::run
