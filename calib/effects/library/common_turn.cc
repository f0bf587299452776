// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/library/common_turn.h"

#include <string>

#include "calib/effects/laws/axis_orthogonality.h"
#include "calib/effects/laws/platform_bending.h"

namespace mgtd::calib::effects::library {
namespace {

constexpr std::string_view kAxes = "xyz";

bool is_orthogonality(const Effect& effect) {
  return effect.name() == laws::OrthogonalityTemperature::kName ||
         effect.name() == laws::OrthogonalityTemperature2::kName;
}

/// Place of an axis, or of one in the name of another, among those of s1: "s1.zx".
int axis_at(const std::string& name, std::size_t place) {
  return static_cast<int>(kAxes.find(name.at(place)));
}

}  // namespace

Eigen::MatrixXd turn_of_first_sensor(const Effect& effect, int sensors) {
  const bool orthogonality = is_orthogonality(effect);
  const bool bending = effect.name() == laws::ThermalBending::kName && sensors > 1;
  if (!orthogonality && !bending) return {};
  const std::size_t own = orthogonality ? 6 : 3;
  const auto& coefficients = effect.coefficients();
  if (coefficients.size() != own * static_cast<std::size_t>(sensors)) return {};
  for (int i = 0; i < sensors; ++i)
    if (effect.at(i).size() != own) return {};
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(3, static_cast<Eigen::Index>(coefficients.size()));
  for (const int j : effect.at(0)) {
    const std::string& name = coefficients[static_cast<std::size_t>(j)].name;
    const std::size_t first = name.rfind('.') + 1;
    if (!orthogonality) {
      out(axis_at(name, first), j) = 1;
      continue;
    }
    const int c = axis_at(name, first), b = axis_at(name, first + 1);
    out(3 - b - c, j) = (c - b + 3) % 3 == 1 ? 0.5 : -0.5;
  }
  return out;
}

}  // namespace mgtd::calib::effects::library
