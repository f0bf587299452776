// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "calib/fit/dwell_motion.h"
#include "calib/fit/joint/agreement.h"
#include "calib/fit/joint/identifiability.h"
#include "calib/fit/joint/joint_setup.h"
#include "calib/fit/joint/reference_scatter.h"
#include "calib/fit/joint/wandering_estimate.h"
#include "calib/fit/quantisation.h"

/// JointFindings holds what only a joint fit finds out, as values; it is part of FitReport.
namespace mgtd::calib::fit::joint {

struct JointFindings {
  Gauge gauge;
  std::array<double, 3> common_rotation_sd_rad{};  ///< JointFit::common_rotation_sd_rad
  double birge_ratio{1};                           ///< JointFit::birge_ratio
  double samples_per_effective{1};                 ///< JointFit::samples_per_effective
  Identifiability known;                           ///< which combinations of parameters the poses determine
  Agreement agreement;                             ///< whether the readings that were kept agree
  WanderingEstimate wandering;                     ///< the covariance of the calibration contains it
  Quantisation quantisation;                       ///< the weights of the fit contain it
  std::optional<ReferenceScatter> reference_scatter;
  std::optional<DwellMotion> dwell_motion;  ///< where the noise is that of the dwells
};

}  // namespace mgtd::calib::fit::joint
