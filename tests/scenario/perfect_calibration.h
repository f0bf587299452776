// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "calib/calibration/calibration.h"
#include "proto/units.h"
#include "tests/rig/scenario.h"

namespace mgtd::test {

/// What a perfect calibration of this rig would be.
inline std::shared_ptr<const calib::calibration::Calibration> perfect_calibration(
    const rig::Scenario& scenario) {
  calib::calibration::Calibration c;
  for (std::size_t i = 0; i < kSensors; ++i) {
    const rig::SensorTruth& s = scenario.truth.at(i);
    calib::sensor::ParameterVector p;
    p << to_rad(s.theta_deg), to_rad(s.phi_deg), to_rad(s.psi_deg), s.scale, s.offset_nT, to_rad(s.alpha_deg),
        to_rad(s.beta_deg), to_rad(s.gamma_deg);
    c.sensors.at(i) = calib::sensor::SensorModel::from_parameters(p);
  }
  c.sample_noise_nT.setConstant(0.3);
  c.covariance.diagonal().setConstant(1e-10);
  c.reference.t_utc = "2026-11-21T10:00:00.000000Z";
  c.accepted_by_checks = true;
  c.seal();
  return std::make_shared<const calib::calibration::Calibration>(std::move(c));
}

}  // namespace mgtd::test
