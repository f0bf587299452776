// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/dipole_field.h"

#include "calib/effects/effect_spec.h"

namespace mgtd::calib::effects::laws {

Result<Eigen::Vector3d> dipole_place_S_m(const EffectSpec& spec) {
  constexpr double kInsideArray_m = 0.05, kFarthest_m = 1000;
  Eigen::Vector3d at;
  for (int i = 0; i < 3; ++i) {
    const auto value = spec.number(std::string(1, "xyz"[i]), 0, -kFarthest_m, kFarthest_m);
    if (!value) return tl::unexpected(value.error());
    at[i] = *value;
  }
  if (at.norm() < kInsideArray_m) {
    return fail(ErrorCode::usage, spec.name + ": its place is the centre of the array",
                "give x, y, z in metres, site frame, at least 0.05 m away");
  }
  return at;
}

void set_dipole_place(const Eigen::Vector3d& place_S_m, EffectSpec& spec) {
  for (int i = 0; i < 3; ++i) spec.set(std::string(1, "xyz"[i]), place_S_m[i]);
}

}  // namespace mgtd::calib::effects::laws
