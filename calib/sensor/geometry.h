// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>

#include "proto/reading.h"

/// Where the sensors sit. Platform frame O-XYZ, baseline d between opposite sensors:
/// s1 (+d/2,0,0), s2 (0,+d/2,0), s3 (-d/2,0,0), s4 (0,-d/2,0). Metres.
namespace mgtd::calib::sensor {

struct Geometry {
  double baseline_m{0.4};

  [[nodiscard]] std::array<Eigen::Vector3d, kSensors> positions_P_m() const {
    const double h = baseline_m / 2;
    return {Eigen::Vector3d{h, 0, 0}, Eigen::Vector3d{0, h, 0}, Eigen::Vector3d{-h, 0, 0},
            Eigen::Vector3d{0, -h, 0}};
  }
};

}  // namespace mgtd::calib::sensor
