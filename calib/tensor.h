// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>

#include "calib/calibration.h"
#include "proto/epoch.h"
#include "proto/tensor.h"

/// Field, gradient tensor and closure of one set of four readings.
///
/// The 12 corrected components b_i (platform frame, sensor at r_i) are fitted by least squares to
///     b_i = B + G r_i,   G symmetric and traceless (5 numbers)
/// which leaves 12 - 3 - 5 = 4 closure quantities. On the cross the six differences decide G:
///     Bxx=(Bx1-Bx3)/d  Byx=(By1-By3)/d  Bzx=(Bz1-Bz3)/d  Bxy=(Bx2-Bx4)/d  Byy=(By2-By4)/d  Bzy=(Bz2-Bz4)/d
///     Gxx = Bxx, Gyy = Byy, Gzz = -(Bxx+Byy), Gxy = (Bxy+Byx)/2, Gxz = Bzx, Gyz = Bzy.
/// Does not remove site effects: a gradient of the site is real field.
namespace mgtd::calib {

struct FieldAndGradient {
  Eigen::Vector3d b_P_nT;
  Gradient g_nT_per_m;
  Closure closure;  ///< chi2 is left NaN here: it needs the noise
};

[[nodiscard]] FieldAndGradient field_and_gradient(const std::array<Eigen::Vector3d, kSensors>& b_P_nT,
                                                  const Geometry& geometry);

/// The stream's arithmetic for one calibration: everything that does not depend on the sample is computed
/// once, so that a sample costs four 3x3 products and a few sums, and allocates nothing.
class TensorPipeline {
 public:
  /// No calibration: readings pass uncorrected (identity), samples are flagged `uncalibrated`, sd and chi2
  /// are NaN.
  explicit TensorPipeline(Geometry geometry);
  explicit TensorPipeline(std::shared_ptr<const Calibration> calibration);

  /// g_sd holds sample noise and calibration covariance together, the latter at the field of this very
  /// sample.
  [[nodiscard]] TensorSample apply(const Epoch& epoch) const;
  [[nodiscard]] const std::shared_ptr<const Calibration>& calibration() const { return calibration_; }

 private:
  std::shared_ptr<const Calibration> calibration_;
  std::shared_ptr<const std::string> id_;
  Geometry geometry_;
  std::array<Eigen::Matrix3d, kSensors> gain_;  ///< R_PS (C A)^-1
  std::array<Eigen::Vector3d, kSensors> offset_nT_;
};

}  // namespace mgtd::calib
