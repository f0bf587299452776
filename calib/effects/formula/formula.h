// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calib/effects/effect.h"
#include "calib/effects/effect_spec.h"
#include "calib/effects/formula/expression.h"

/// A user can define an effect by a formula, which is written out in the spec of the effect:
///
///     lamp@s3.z,level=platform,unit=nT/A,expr=lamp_A
///     creep@each-axis,level=axis,tau=2..120,expr=k*(u - 20000)*exp(-since_stop_s/tau)
///
/// The expression is the term of one axis (axis: added to its reading; platform: to that component of the
/// field at the sensor), or what coefficients of the site's field are multiplied by: those of a vector x, y,
/// z (level site) or of a gradient Gxx, Gyy, Gxy, Gxz, Gyz, symmetric and without trace (level gradient). It
/// may name
///     k, k1 .. k3          coefficients; none: the whole is multiplied by one
///     a declared number    scanned from .. to where the spec gives a range, fixed where it gives a value
///     t_h                  hours since the start; T_degC the sensor's own temperature
///     azimuth_deg, pitch_deg, roll_deg, sense, mount, dwell_s, since_stop_s, f_nT, s1_T_degC .. s4_T_degC
///     pose                 its number; prev_X, lag600_X, rate_X: what was before (history_name.h)
///     u, ux, uy, uz        axis: the axis' own field term and those of its sensor, nT
///     b, bx, by, bz        platform: the same of the field at the sensor, nT; gx, gy, gz unit gravity
///     px, py, pz           site: place, m, from the centre of the array; a gradient is the same everywhere
/// and any other column of the pose table. Coefficients must come in linearly: that is tried and refused
/// otherwise. Derivatives by the field are central differences; see derivative_check.h.
namespace mgtd::calib::effects::formula {
inline constexpr std::size_t kFormulaCoefficients = 3;

/// A number of a formula that is looked for.
struct FormulaScan {
  std::string parameter;
  double from{0}, to{0};
};

/// The range that a spec leaves open; empty when it has none, or a value.
[[nodiscard]] std::optional<FormulaScan> open_scan(const EffectSpec& spec);
[[nodiscard]] std::vector<double> scan_values(const FormulaScan& scan);

[[nodiscard]] bool is_formula(const EffectSpec& spec);
[[nodiscard]] Result<EffectPtr> make_formula(const EffectSpec& spec);

/// Every column it names is one that the table has; refuses with the column of the expression and the names
/// there are.
[[nodiscard]] Result<void> check_columns(const EffectSpec& spec, const PoseTable& table);

}  // namespace mgtd::calib::effects::formula
