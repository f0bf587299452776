// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calib/calibration/effect_correction.h"
#include "calib/calibration/tensor.h"

/// A LiveTensor turns each sample of a stream into field and tensor with the active calibration and its
/// effects. What the instrument adds is computed from live temperatures, time, table angles, currents and the
/// path of the readings themselves, and is removed; effects of the site stay in.
///
/// An effect whose inputs are not measured now is left out, g_sd is wider by its size in the calibration's
/// own run, and the sample is flagged `incomplete`; left_out() says which and what it lacks. The part of g_sd
/// that the calibration contributes changes slowly and is computed again after kRefresh samples, when the
/// field has turned or changed by 0.2 %, or when another effect is left out.
namespace mgtd::calib::calibration {

/// What is known beside the epoch.
struct LiveConditions {
  std::optional<TableAngles> angles;                         ///< of a referenced table that stands
  const std::map<std::string, double>* covariates{nullptr};  ///< currents and the like, by column
};

/// An effect of the calibration that is not removed now.
struct LeftOutEffect {
  std::string effect, lacks;
  bool operator==(const LeftOutEffect&) const = default;
};

class LiveTensor {
 public:
  /// No calibration: as TensorPipeline.
  explicit LiveTensor(const sensor::Geometry& geometry);
  explicit LiveTensor(const std::shared_ptr<const Calibration>& calibration);

  /// Epochs in order of time.
  [[nodiscard]] TensorSample apply(const Epoch& epoch, const LiveConditions& conditions = {});

  /// The corrected field at each sensor at the last epoch, platform frame, one below the other; without a
  /// calibration the readings.
  [[nodiscard]] const sensor::FieldVector& fields_P_nT() const { return fields_P_nT_; }
  /// At the last epoch; all that have inputs before the first one.
  [[nodiscard]] const std::vector<LeftOutEffect>& left_out() const { return left_out_; }
  [[nodiscard]] const std::shared_ptr<const Calibration>& calibration() const {
    return pipeline_.calibration();
  }

 private:
  static constexpr int kRefresh = 50;

  void look_around(const Epoch& epoch, const LiveConditions& conditions);
  void refresh(const sensor::FieldVector& b_P_nT);

  TensorPipeline pipeline_;
  std::unique_ptr<const EffectCorrection> effects_;  ///< null without effects of the instrument
  Pose now_;                                         ///< reused, so that a sample allocates little
  std::vector<LeftOutEffect> left_out_;
  sensor::FieldVector fields_P_nT_;
  // Of the calibration and the noise, at field at_P_nT_:
  int fresh_{0};
  Eigen::Vector3d at_P_nT_{Eigen::Vector3d::Zero()};
  Gradient g_sd_nT_per_m_;
  Eigen::Vector3d along_line_sd_nT_per_m_{Eigen::Vector3d::Zero()};
  sensor::ChannelCovariance closure_weight_;  ///< inverse covariance of the closure
};

}  // namespace mgtd::calib::calibration
