// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/calibration/calibration.h"

/// sealed_calibration() makes a calibration of a cross without errors, measured at a given time, with a plain
/// covariance.
namespace mgtd::testing {

inline constexpr double kOffsetSd_nT = 0.1, kScaleSd = 1e-6, kAngleSd_rad = 1e-6;

[[nodiscard]] inline calib::calibration::Calibration sealed_calibration(const std::string& t_utc,
                                                                        bool good = true) {
  calib::calibration::Calibration c;
  c.method = "joint";
  c.poses = 157;
  c.reference.t_utc = t_utc;
  c.reference.f_nT = 50'000;
  c.accepted_by_checks = good;
  c.checks = {{"total field", good, "0.8 nT", "1.0 nT", ""}};
  for (Eigen::Index slot = 0; slot < c.covariance.rows(); ++slot) {
    const Eigen::Index of_sensor = slot % calib::sensor::kSensorParameters;
    const bool offset = of_sensor >= calib::sensor::ix && of_sensor <= calib::sensor::iz;
    const bool scale = of_sensor >= calib::sensor::cx && of_sensor <= calib::sensor::cz;
    const double sd = offset ? kOffsetSd_nT : scale ? kScaleSd : kAngleSd_rad;
    c.covariance(slot, slot) = sd * sd;
  }
  for (std::size_t s = 0; s < c.sensors.size(); ++s)
    c.sensors[s].offset_nT = {10.0 + static_cast<double>(s), -20.0, 30.0};
  c.software = "mgtd test";
  c.seal();
  return c;
}

}  // namespace mgtd::testing
