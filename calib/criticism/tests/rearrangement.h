// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calib/calibration/tensor.h"
#include "calib/criticism/live/live_criticism.h"
#include "proto/epoch.h"

/// Sensors that are in another place or stand otherwise than when they were calibrated, found from readings.
///
///     exchanged   the readings of the four, given to each other's calibrations, have a closure within noise
///                 and calibration (chi-square of 4 below kExplained); as they come, beyond ten standard
///                 deviations
///     turned      the field of one sensor, turned by quarters about the platform's axes, agrees with the
///                 other three to 5 % of the field, as well as a hand turns; those agree to 2 %
///
/// An exchange is told from another where the sensors differ, by some nT of offset for instance. A turn about
/// the field itself changes nothing and is not seen; what one attitude leaves open, the next ones close.
namespace mgtd::calib {

struct Rearrangement {
  std::array<std::size_t, kSensors> sensor{0, 1, 2, 3};  ///< whose readings come in each place
  std::optional<std::size_t> turned{};                   ///< one of the sensors ...
  Eigen::Matrix3d turn_P{Eigen::Matrix3d::Identity()};   ///< ... by so much
};

/// "s2 and s4 are exchanged", "s3 is turned by 90 deg about Z".
[[nodiscard]] std::string in_words(const Rearrangement& what);

/// All exchanges (23) and turns (4 x 23) that explain the readings of one epoch.
[[nodiscard]] std::vector<Rearrangement> exchanges_explaining(const TensorPipeline& pipeline,
                                                              const Epoch& epoch);
[[nodiscard]] std::vector<Rearrangement> turns_explaining(const TensorPipeline& pipeline, const Epoch& epoch);

/// Over the samples of a stream: concludes after ten samples running that are explained alike, and withdraws
/// it after ten that need no explanation, or when nothing explains them any more.
class RearrangementWatch {
 public:
  RearrangementWatch() = default;
  explicit RearrangementWatch(const std::shared_ptr<const Calibration>& calibration);

  /// `beyond`: as LiveCriticism says of this sample; nothing where it was not judged.
  void add(const Epoch& epoch, std::optional<bool> beyond);
  /// State exchanged or turned; empty while nothing is concluded.
  [[nodiscard]] const std::optional<LiveFinding>& finding() const { return finding_; }

 private:
  void explain(const Epoch& epoch);
  void conclude(const Epoch& epoch);

  std::optional<TensorPipeline> pipeline_;
  std::vector<Rearrangement> possible_;  ///< explain all samples of those counted
  int explained_{0}, calm_{0};
  std::optional<LiveFinding> finding_;
};

}  // namespace mgtd::calib
