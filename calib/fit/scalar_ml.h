// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/step1.h"

/// One sensor by itself, maximum likelihood: what step 1 linearises.
namespace mgtd::calib {

struct ScalarMl {
  ScalarCalibration sensor;
  double residual_rms_nT{0};  ///< of |K (y - I)| - F
  double raw_residual_rms_nT{
      0};  ///< the same as a distance of the readings from the ellipsoid; what is minimised
  int iterations{0};
};

/// Minimises the sum of squares of r = (|K (y - I)| - F) / |K' u|, u the direction of the field: the distance
/// in *raw* readings. In |b| alone the collapse K -> 0, I -> infinity fits every constant field exactly; in
/// raw units it costs the whole spread of the readings. Levenberg-Marquardt from `start`. Refuses what does
/// not settle, and a determinant of K that no sensor read at nominal scale can have.
[[nodiscard]] Result<ScalarMl> scalar_ml(const Eigen::Matrix3Xd& y_nT, const Eigen::VectorXd& f_nT,
                                         const ScalarCalibration& start);

}  // namespace mgtd::calib
