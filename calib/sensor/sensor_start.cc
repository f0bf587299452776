// SPDX-License-Identifier: Apache-2.0
#include "calib/sensor/sensor_start.h"

#include <fmt/format.h>

#include <cmath>

#include "calib/linear/qr.h"
#include "calib/linear/symmetric_eigen.h"

namespace mgtd::calib::sensor {
namespace {

/// Spread across the thinnest direction over the widest: below, the readings lie on a plane. A table turning
/// about one axis with 0.1 degree of wobble reaches 0.004, tilts of 5 degrees reach 0.1.
constexpr double kFlat = 0.02;
/// An axis that moves less over all poses does not measure.
constexpr double kDead_nT = 1e-3;
/// Scale factors and axis ratios a fluxgate cannot have.
constexpr double kMaxScale = 3;

/// |z|^2 = 2 c' z + d.
ScalarCalibration sphere(const Eigen::Matrix3Xd& z, double f_nT) {
  Eigen::MatrixXd d(z.cols(), 4);
  d << 2 * z.transpose(), Eigen::VectorXd::Ones(z.cols());
  const Eigen::Vector4d p = linear::least_squares(d, Eigen::VectorXd(z.colwise().squaredNorm().transpose()));
  const Eigen::Vector3d centre = p.head<3>();
  ScalarCalibration out;
  out.K *= f_nT / std::sqrt(p[3] + centre.squaredNorm());
  out.offset_nT = centre;
  return out;
}

bool plausible(const ScalarCalibration& s) {
  const Eigen::Vector3d d = s.K.diagonal();
  return d.minCoeff() > 1 / kMaxScale && d.maxCoeff() < kMaxScale && s.K.cwiseAbs().maxCoeff() < kMaxScale;
}

}  // namespace

Result<ScalarCalibration> sensor_start(const Eigen::Matrix3Xd& y_nT, const Eigen::VectorXd& f_nT) {
  if (y_nT.cols() < kFewestScalarPoses) return scalar_calibration(y_nT, f_nT);  // refuses in its words
  const Eigen::Vector3d mean = y_nT.rowwise().mean();
  const Eigen::Matrix3Xd z = y_nT.colwise() - mean;
  const Eigen::Matrix3d scatter = z * z.transpose() / static_cast<double>(z.cols());
  const Eigen::Vector3d spread = linear::principal_axes(scatter).values.cwiseMax(0).cwiseSqrt();
  for (int a = 0; a < 3; ++a) {
    if (z.row(a).cwiseAbs().maxCoeff() > kDead_nT) continue;
    return fail(
        ErrorCode::refused,
        fmt::format("its axis {} reads {:.3f} nT in every pose: it is dead or stuck", "xyz"[a], mean[a]),
        "check this axis, its cable and its channel of the digitiser");
  }
  if (!(spread[0] > kFlat * spread[2])) {
    return fail(ErrorCode::refused,
                fmt::format("the readings lie on a plane: they spread {:.4g} nT across it and {:.4g} nT "
                            "along it (limit {} of it)",
                            spread[0], spread[2], kFlat),
                "poses about one axis only do not determine a sensor: turn the rig about a second and a "
                "third axis as well");
  }
  auto step1 = scalar_calibration(y_nT, f_nT);
  if (step1 && plausible(*step1)) return step1;
  ScalarCalibration out = sphere(z, f_nT.mean());
  out.offset_nT += mean;
  return out;
}

}  // namespace mgtd::calib::sensor
