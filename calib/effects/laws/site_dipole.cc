// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/site_dipole.h"

namespace mgtd::calib::effects::laws {

Eigen::Vector3d dipole_place_S_m(int place) {
  constexpr int kDirections = 26, kMiddle = 13;
  const double distance_m = place < kDirections ? 0.6 : 1.2;
  int cell = place % kDirections;
  if (cell >= kMiddle) ++cell;  // the centre itself is no direction
  const Eigen::Vector3d d(cell % 3 - 1, cell / 3 % 3 - 1, cell / 9 - 1);
  return distance_m * d.normalized();
}

SiteDipole::SiteDipole(std::optional<Eigen::Vector3d> place_S_m)
    : given_(place_S_m.has_value()), start_S_m_(place_S_m ? *place_S_m : dipole_place_S_m(0)) {
  constexpr double kShiftPrior_m = 0.5;
  for (const char* name : {"mx", "my", "mz"}) add(name, "A m^2", 0.1);
  for (const char* name : {"dx", "dy", "dz"}) add(name, "m", 0.3, kShiftPrior_m);
}

std::string SiteDipole::spec() const {
  EffectSpec out{.name = std::string(kName), .where = {}, .parameters = {}};
  if (given_) set_dipole_place(start_S_m_, out);
  return out.text();
}

}  // namespace mgtd::calib::effects::laws
