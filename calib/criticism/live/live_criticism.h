// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "calib/criticism/live/live_finding.h"
#include "calib/criticism/live/live_follow.h"
#include "proto/epoch.h"
#include "proto/tensor.h"

/// LiveCriticism judges the active calibration by the stream itself: by the closure quantities, which vanish
/// in any field that is uniform but for a constant gradient. An array without closure is not judged.
///
///     suspect       they follow temperature, time or attitude: no field outside knows of these, so the
///                   calibration no longer holds. In the last hour (blocks of 10 s) or the last day (of
///                   10 min): chance below 1e-8, half of what they do beyond their noise explained and
///                   more than an event (one interval of time) explains, and a swing larger than the
///                   standard deviation that the calibration states for them.
///
///     near source   they are larger than noise and calibration allow (chance below 1e-5 in 10 s, twice
///                   running) and follow nothing: something magnetic is so near that its field has
///                   curvature across the array. It ends after a minute without.
///
///     beyond        of one sample: ten standard deviations from zero, by the noise and the calibration at
///                   its field. The cause is found from the samples after it; this one is flagged at once.
///
/// Not judged: samples that are saturated or frozen, that lack an effect of the calibration, or whose field
/// turns so fast that the skew bound lets it move by more than half the noise. An effect of the calibration
/// whose coefficient is badly known widens what is stated for the sample but not what is stated here.
namespace mgtd::calib::criticism::live {

class LiveCriticism {
 public:
  /// Nothing to judge by: state none.
  LiveCriticism() = default;
  /// None also where the calibration does not know its noise, and where the array has no closure (one sensor,
  /// sensors on a line).
  explicit LiveCriticism(const calibration::Calibration& calibration);

  /// True when the state changed. `T_degC`: of the heads, NaN where not measured.
  bool add(const TensorSample& sample, const PerSensor<double>& T_degC);
  /// The same without a stream around it.
  bool add(const ClosureSample& sample);
  [[nodiscard]] const LiveFinding& finding() const { return finding_; }
  /// Whether the closure of the last sample is beyond ten standard deviations; nothing where it was not
  /// judged.
  [[nodiscard]] std::optional<bool> beyond() const { return beyond_; }

 private:
  struct Judges {
    explicit Judges(const ClosurePrior& p);
    ClosurePrior prior;
    double least_noise_nT;  ///< of one sample, in a quantity in nT
    double beyond_chi2;     ///< of one sample: ten standard deviations of the four of the cross, or as rare
    LiveWindow hour, day;
  };
  /// What the turn of the field may add to the closure, within the skew of the sensors.
  [[nodiscard]] double turn_nT(const TensorSample& sample);
  void judge(const LiveWindow& window);
  void judge_nearness(double log10_p);
  [[nodiscard]] LiveState state() const;

  std::optional<Judges> judges_;
  std::optional<std::pair<double, Eigen::Vector3d>> last_;  ///< time and field of the sample before
  std::optional<FollowedQuantity> followed_hour_, followed_day_;
  std::optional<LargeClosure> near_;
  std::vector<Follows> tested_;  ///< what the closure of the last hour could be compared with
  bool large_before_{false};     ///< the block before the last was beyond what is possible
  int calm_blocks_{0}, until_look_{0};
  double noise_scale_{1};
  std::optional<bool> beyond_;
  LiveFinding finding_;
};

}  // namespace mgtd::calib::criticism::live
