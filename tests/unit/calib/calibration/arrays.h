// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "calib/calibration/field_expansion.h"

/// Places of sensors that tests use by name, m.
namespace mgtd::calib::calibration::test {

using Places = std::vector<Eigen::Vector3d>;

inline FieldExpansion expansion_of(const Places& places) { return FieldExpansion::of(places).value(); }

inline Places cross(double h) { return {{h, 0, 0}, {0, h, 0}, {-h, 0, 0}, {0, -h, 0}}; }

inline Places tetrahedron(double h) { return {{h, h, h}, {h, -h, -h}, {-h, h, -h}, {-h, -h, h}}; }

inline Places cube(double h) {
  Places out;
  for (const double x : {-h, h}) {
    for (const double y : {-h, h}) {
      for (const double z : {-h, h}) out.emplace_back(x, y, z);
    }
  }
  return out;
}

}  // namespace mgtd::calib::calibration::test
