// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "calib/calibration/calibration.h"
#include "calib/effects/library/library.h"

namespace mgtd::calib::validity {

/// A FixedCalibration is a calibration that is held while other poses are compared with it. It says which
/// slots of the joint fit's fixed block are under test, and which are free because they belong to the site.
struct FixedCalibration {
  std::vector<effects::EffectPtr> effects;  ///< its own, then those of the site that the operator adds
  Eigen::VectorXd coefficients;
  std::vector<calibration::CalibratedEffect> instrument;  ///< those under test
  std::vector<Eigen::Index> tested, nuisance;             ///< slots of the fixed block
  Eigen::MatrixXd covariance;                             ///< of the tested slots
  bool needs_angles{false};
};

/// Refuses an effect that the library does not know, and an `added` one that does not belong to the site.
[[nodiscard]] Result<FixedCalibration> fixed_calibration(const calibration::Calibration& calibration,
                                                         const std::vector<effects::EffectPtr>& added);

}  // namespace mgtd::calib::validity
