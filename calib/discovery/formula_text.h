// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/discovery/fitted_law.h"

/// These functions write formulas as text: for a person, and as effects of the user's own.
namespace mgtd::calib::discovery {

/// T for T_degC, x, y, z for the sensor's readings without offset over 50 000 nT (u where several axes read
/// their own), lag(T, 600 s), dT/dt, gx, gy, gz for unit gravity in the
/// platform's frame. Several columns: "a*sin(..) + b*cos(..)".
[[nodiscard]] std::string shown(const Columns& columns, const Place& place);

/// A covariate as the pose table calls it, where the law acts on one sensor: "s3_T_degC", "s3.z".
[[nodiscard]] std::string shown_covariate(const std::string& name, const Place& place);

/// Effects that are the law, as --with reads them.
[[nodiscard]] std::vector<std::string> specs_of(const Columns& columns, const Place& place,
                                                const std::string& name);

/// Where each coefficient of a fitted law acts, in the order of FittedLaw::value.
[[nodiscard]] std::vector<std::string> coefficient_places(const Columns& columns, const Place& place,
                                                          int channels);

}  // namespace mgtd::calib::discovery
