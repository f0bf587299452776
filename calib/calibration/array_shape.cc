// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration/array_shape.h"

#include <cmath>

#include "calib/linear/symmetric_eigen.h"

namespace mgtd::calib::calibration {
namespace {

/// Components of a unit vector below this are rounding of the principal axes.
constexpr double kDirectionRounding = 1e-9;

Eigen::Vector3d direction_of_line(Eigen::Vector3d u) {
  u = (u.array().abs() < kDirectionRounding).select(0, u).normalized();
  for (const double component : u) {
    if (component != 0) return component > 0 ? u : Eigen::Vector3d(-u);
  }
  return u;
}

double longest(const Eigen::Matrix3Xd& vectors) { return vectors.colwise().norm().maxCoeff(); }

}  // namespace

bool ArrayShape::spans(const Eigen::Vector3d& direction_P) const {
  return (direction_P - span_P * (span_P.transpose() * direction_P)).norm() <= kNegligible;
}

ArrayShape shape_of(const Eigen::Matrix3Xd& places_P_m) {
  ArrayShape out;
  out.centroid_P_m = places_P_m.rowwise().mean();
  out.offsets_P_m = places_P_m.colwise() - out.centroid_P_m;
  out.size_m = longest(out.offsets_P_m);
  out.span_P.resize(3, 0);
  if (out.size_m <= kOnePlace_m) {
    out.neglected_m = out.size_m;
    out.offsets_P_m.setZero();
    return out;
  }
  const Eigen::Matrix3Xd s = out.offsets_P_m / out.size_m;
  const linear::PrincipalAxes principal = linear::principal_axes(s * s.transpose());  // ascending
  const Eigen::Vector3d u = direction_of_line(principal.vectors.col(2));
  const Eigen::Matrix3Xd on_line = u * (u.transpose() * out.offsets_P_m);
  const double off_line_m = longest(out.offsets_P_m - on_line);
  if (off_line_m <= kNegligible * out.size_m) {
    out.span_P = u;
    out.offsets_P_m = on_line;
    out.neglected_m = off_line_m;
  } else if ((principal.vectors.col(0).transpose() * s).cwiseAbs().maxCoeff() <= kNegligible) {
    out.span_P = principal.vectors.rightCols<2>();
  } else {
    out.span_P = Eigen::Matrix3d::Identity();
  }
  return out;
}

}  // namespace mgtd::calib::calibration
