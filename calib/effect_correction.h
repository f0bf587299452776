// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "calib/array_model.h"
#include "calib/calibration.h"
#include "calib/run_time.h"

/// Readings to fields by a calibration that carries effects, with what the calibration leaves uncertain.
/// Costs some ten microseconds a sample; without effects TensorPipeline has a cheaper way.
namespace mgtd::calib {

struct Corrected {
  FieldVector b_P_nT;  ///< instrument effects removed; the site's too where asked
  /// By the 48 parameters and the coefficients, to first order in the effects, and by the effects that were
  /// left out (their size in the calibration's own run, squared, channel by channel). Sample noise is not in
  /// it.
  ChannelCovariance covariance;
};

class EffectCorrection {
 public:
  /// The effects of `calibration` must be in the library (calibration_from_json makes sure). `run`: the poses
  /// that are to be corrected, for effects with a memory; without it they know the pose before only.
  explicit EffectCorrection(const Calibration& calibration, const PoseTable* run = nullptr);

  [[nodiscard]] bool has_site_effects() const { return array_.has_site_effects(); }
  [[nodiscard]] bool has_instrument_effects() const { return array_.has_instrument_effects(); }

  struct LeftOut {
    std::string_view effect;  ///< its name
    std::string_view column;  ///< what the pose lacks
  };
  /// Effects that should be removed at this pose and cannot be.
  [[nodiscard]] std::vector<LeftOut> left_out(const Pose& pose, bool remove_site) const;
  /// `remove_site` needs the pose's table angles. `previous`: the pose before, for effects with a memory.
  [[nodiscard]] Corrected correct(const Pose& pose, const FieldVector& y_nT, bool remove_site,
                                  const Pose* previous = nullptr) const;

 private:
  [[nodiscard]] bool acts(const Effect& effect, bool remove_site) const;

  std::vector<EffectPtr> effects_;
  std::vector<FieldVector> size2_nT2_;  ///< of each effect
  ArrayModel array_;
  Eigen::MatrixXd covariance_;  ///< of parameters and coefficients
  CovariateMeans means_;
  RunTime time_;
};

}  // namespace mgtd::calib
