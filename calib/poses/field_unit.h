// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string_view>

namespace mgtd::calib::poses {

/// A FieldUnit is a unit of magnetic flux density that is not nT: T, mT, G, uT, mG or pT.
struct FieldUnit {
  std::string_view name;
  std::string_view factor;  ///< what a number in it is multiplied by to be in nT
};

/// Field of the Earth, nT, to a factor of three.
inline constexpr double kEarthlyField_nT = 5e4;

/// The unit of a number that is `ratio` times what it would be in nT: the nearest one. Empty where the ratio
/// is within a factor of thirty of one, for sensors show the field to a factor of three, or of no unit's.
[[nodiscard]] std::optional<FieldUnit> field_unit_of(double ratio);

}  // namespace mgtd::calib::poses
