// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "calib/calibration/array_model.h"
#include "calib/calibration/calibration.h"
#include "calib/effects/laws/live_memory.h"
#include "calib/poses/run_time.h"

/// An EffectCorrection turns readings into fields with a calibration that carries effects, and says what the
/// calibration leaves uncertain in them. It costs some ten microseconds a pose; without effects
/// TensorPipeline has a cheaper way, and LiveTensor has one for a stream.
namespace mgtd::calib::calibration {

struct Corrected {
  sensor::FieldVector b_P_nT;  ///< instrument effects removed; the site's too where asked
  /// By the 48 parameters and the coefficients, to first order in the effects, and by the effects that were
  /// left out (their size in the calibration's own run, squared, channel by channel). Sample noise is not in
  /// it.
  sensor::ChannelCovariance covariance;
};

class EffectCorrection {
 public:
  /// The effects of `calibration` must be in the library (calibration_from_json makes sure). `run`: the poses
  /// that are to be corrected, for effects with a memory; without it they know the pose before only.
  explicit EffectCorrection(const Calibration& calibration, const PoseTable* run = nullptr);

  /// For a stream: effects with a memory read one of those in memories(), which the caller moves on.
  [[nodiscard]] static EffectCorrection live(const Calibration& calibration);
  [[nodiscard]] const std::vector<std::shared_ptr<effects::laws::LiveMemory>>& memories() const {
    return memories_;
  }
  /// Whether the time since the run of the calibration is known.
  [[nodiscard]] bool knows_start() const { return time_.start.has_value(); }

  [[nodiscard]] bool has_site_effects() const { return array_.has_site_effects(); }
  [[nodiscard]] bool has_instrument_effects() const { return array_.has_instrument_effects(); }

  struct LeftOut {
    std::string_view effect;  ///< its name
    std::string_view column;  ///< what the pose lacks
  };
  /// Effects that should be removed at this pose and cannot be.
  [[nodiscard]] std::vector<LeftOut> left_out(const Pose& pose, bool remove_site) const;
  /// The corrected fields alone.
  [[nodiscard]] sensor::FieldVector fields(const Pose& pose, const sensor::FieldVector& y_nT) const;
  /// What Corrected::covariance holds, at corrected fields, site effects left in.
  [[nodiscard]] sensor::ChannelCovariance covariance(const Pose& pose,
                                                     const sensor::FieldVector& b_P_nT) const;
  /// `remove_site` needs the pose's table angles. `previous`: the pose before, for effects with a memory.
  [[nodiscard]] Corrected correct(const Pose& pose, const sensor::FieldVector& y_nT, bool remove_site,
                                  const Pose* previous = nullptr) const;

 private:
  EffectCorrection(const Calibration& calibration, std::vector<effects::EffectPtr> effects);
  [[nodiscard]] bool acts(const effects::Effect& effect, bool remove_site) const;
  /// Empty where no effect of the instrument asks for it.
  [[nodiscard]] std::optional<Eigen::Matrix3d> attitude_for_instrument(const effects::Conditions& at) const;
  [[nodiscard]] sensor::ChannelCovariance covariance(const effects::Conditions& at,
                                                     const sensor::FieldVector& b_P_nT,
                                                     const std::optional<Eigen::Matrix3d>& R,
                                                     bool remove_site) const;

  std::vector<effects::EffectPtr> effects_;
  std::vector<std::shared_ptr<effects::laws::LiveMemory>> memories_;
  std::vector<sensor::FieldVector> size2_nT2_;  ///< of each effect
  ArrayModel array_;
  Eigen::MatrixXd covariance_;  ///< of parameters and coefficients
  effects::CovariateMeans means_;
  poses::RunTime time_;
};

}  // namespace mgtd::calib::calibration
