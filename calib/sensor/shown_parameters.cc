// SPDX-License-Identifier: Apache-2.0
#include "calib/sensor/shown_parameters.h"

#include "proto/units.h"

namespace mgtd::calib::sensor {

const std::array<ShownParameter, kSensorParameters>& shown_parameters() {
  constexpr double kDegrees = 1 / kRadiansPerDegree;
  static constexpr std::array<ShownParameter, kSensorParameters> kShown{
      {{"theta_deg", "theta", "deg", kDegrees},
       {"phi_deg", "phi", "deg", kDegrees},
       {"psi_deg", "psi", "deg", kDegrees},
       {"cx", "cx", "", 1},
       {"cy", "cy", "", 1},
       {"cz", "cz", "", 1},
       {"ix_nT", "ix", "nT", 1},
       {"iy_nT", "iy", "nT", 1},
       {"iz_nT", "iz", "nT", 1},
       {"alpha_deg", "alpha", "deg", kDegrees},
       {"beta_deg", "beta", "deg", kDegrees},
       {"gamma_deg", "gamma", "deg", kDegrees}}};
  return kShown;
}

}  // namespace mgtd::calib::sensor
