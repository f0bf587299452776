// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string_view>

#include "tests/blind/hidden_run.h"

/// These laws are hidden on one axis with unit coefficient; their equations are written here once more. Those
/// under "none" are in no library.
namespace mgtd::calib::testing {

struct HiddenLaw {
  std::string_view name;        ///< of the library's effect, or "none: ..."
  std::string_view parameters;  ///< its fixed number, as a spec has it
  double (*law)(const Pose& pose, int sensor, int axis, const Eigen::Vector3d& v);
};

[[nodiscard]] std::span<const HiddenLaw> hidden_laws();
[[nodiscard]] std::span<const HiddenLaw> unlisted_laws();
/// The own square, and the squares of the two transverse axes: F^2 less the own square.
[[nodiscard]] std::span<const HiddenLaw> one_field_laws();

/// The library's own effect on that axis, for an oracle.
[[nodiscard]] std::string spec_of(const HiddenLaw& law, int sensor, int axis);

/// The law on one axis, `size` times.
[[nodiscard]] Hidden hide(const HiddenLaw& law, int sensor, int axis, double size);

}  // namespace mgtd::calib::testing
