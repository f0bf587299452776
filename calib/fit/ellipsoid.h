// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "proto/error.h"

/// A first guess of one sensor by itself, from readings in a field of nearly constant magnitude.
///
///     |K (y - I)| = F,   K upper triangular (eq. 6)
///
/// Linear fit of the quadric z' Q z + l' z = 1 to *centred and scaled* readings z = (y - mean) / spread: the
/// mean of points on an ellipsoid lies inside it, so the right-hand side keeps its sign however large the
/// offset is. Where the quadric is not an ellipsoid (poor coverage, outliers), the best sphere is returned
/// and `is_sphere` says so. A start, not an estimate: noise enters squared and F is taken as constant.
namespace mgtd::calib {

struct Ellipsoid {
  Eigen::Matrix3d K{Eigen::Matrix3d::Identity()};
  Eigen::Vector3d offset_nT{Eigen::Vector3d::Zero()};
  bool is_sphere{false};
};

/// Needs at least nine readings. Refuses readings that do not span a volume.
[[nodiscard]] Result<Ellipsoid> fit_ellipsoid(const std::vector<Eigen::Vector3d>& y_nT, double f_nT);

}  // namespace mgtd::calib
