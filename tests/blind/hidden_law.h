// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string_view>

#include "tests/blind/hidden_run.h"

/// Laws that are hidden on one axis, unit coefficient; their equations are written here once more. Those
/// under "none" are in no library.
namespace mgtd::calib::testing {

struct HiddenLaw {
  std::string_view name;  ///< of the library's effect, or "none: ..."
  double (*law)(const Pose& pose, int sensor, int axis, const Eigen::Vector3d& v);
};

[[nodiscard]] std::span<const HiddenLaw> hidden_laws();
[[nodiscard]] std::span<const HiddenLaw> unlisted_laws();

/// The law on one axis, `size` times.
[[nodiscard]] Hidden hide(const HiddenLaw& law, int sensor, int axis, double size);

}  // namespace mgtd::calib::testing
