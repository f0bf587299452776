// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "calib/calibration/tensor.h"
#include "proto/epoch.h"

/// A Rearrangement says which sensors, by their readings, are in another place, or are mounted otherwise,
/// than when they were calibrated.
///
///     exchanged   the readings of the sensors, given to each other's calibrations, have a closure within
///                 noise and calibration (chi-square below explained_closure_chi2()); as they come,
///                 beyond ten standard deviations
///     turned      the field of one sensor, turned by quarters about the platform's axes, agrees with the
///                 others to kTurnAgreement of the field; those agree to 2 %
///
/// Two exchanges can be told apart where the sensors differ, by some nT of offset for instance. A turn about
/// the field itself changes nothing and is not seen; what one attitude leaves open, the next ones close.
namespace mgtd::calib::criticism::tests {

struct Rearrangement {
  PerSensor<std::size_t> sensor{0, 1, 2, 3};            ///< whose readings come in each place
  std::optional<std::size_t> turned{};                  ///< one of the sensors ...
  Eigen::Matrix3d turn_P{Eigen::Matrix3d::Identity()};  ///< ... by so much
};

/// Of so many closure numbers: 30 of four, which one in 2e5 intact samples exceeds; as rare of others.
[[nodiscard]] double explained_closure_chi2(int dof);
inline constexpr double kTurnAgreement = 0.05;  ///< of the field, as well as a hand turns

/// The exchanges of possible_exchanges() and the turns (23 a sensor) that explain the readings of one epoch.
[[nodiscard]] std::vector<Rearrangement> exchanges_explaining(const calibration::TensorPipeline& pipeline,
                                                              const Epoch& epoch);
[[nodiscard]] std::vector<Rearrangement> turns_explaining(const calibration::TensorPipeline& pipeline,
                                                          const Epoch& epoch);

struct RearrangementFinding {
  std::vector<Rearrangement> possible;  ///< all of them exchanges, or all of them turns
  double chi2{0};                       ///< of the closure as it came
  int dof{4};                           ///< its degrees of freedom
  [[nodiscard]] bool turned() const { return possible.front().turned.has_value(); }
};

/// Watches the samples of a stream: concludes after ten samples running that are explained alike, and
/// withdraws it after ten that need no explanation, or when nothing explains them any more.
class RearrangementWatch {
 public:
  RearrangementWatch() = default;
  explicit RearrangementWatch(const std::shared_ptr<const calibration::Calibration>& calibration);

  /// `beyond`: as LiveCriticism says of this sample; nothing where it was not judged.
  void add(const Epoch& epoch, std::optional<bool> beyond);
  /// Empty while nothing is concluded.
  [[nodiscard]] const std::optional<RearrangementFinding>& finding() const { return finding_; }

 private:
  void explain(const Epoch& epoch);
  void conclude(const Epoch& epoch);

  std::optional<calibration::TensorPipeline> pipeline_;
  std::vector<Rearrangement> possible_;  ///< explain all samples of those counted
  int explained_{0}, calm_{0};
  std::optional<RearrangementFinding> finding_;
};

}  // namespace mgtd::calib::criticism::tests
