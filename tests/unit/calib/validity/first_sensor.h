// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/fit_options.h"
#include "proto/pose.h"

/// What the first sensor of an array measured, as if it were alone, and the options of a fit of it.
namespace mgtd::calib::testing {

inline PoseTable first_sensor_of(PoseTable table) {
  for (Pose& pose : table.poses) {
    pose.y_nT.resize(1);
    pose.sd_nT.resize(1);
    pose.T_degC.resize(1);
  }
  return table;
}

inline fit::FitOptions at_the_origin() {
  fit::FitOptions out;
  out.geometry = sensor::Geometry(PerSensor<Eigen::Vector3d>{Eigen::Vector3d(Eigen::Vector3d::Zero())});
  return out;
}

}  // namespace mgtd::calib::testing
