// SPDX-License-Identifier: Apache-2.0
#include "calib/report/described_array.h"

#include <fmt/format.h>

#include "calib/calibration/field_expansion.h"
#include "calib/report/array_text.h"
#include "calib/stats/chi_square.h"

namespace mgtd::calib::report {

double closure_limit(double dof) { return stats::chi_square_limit(1e-3, dof); }

ArrayDescription described(const sensor::Geometry& array) {
  const auto& places = array.positions_P_m();
  const auto expansion = calibration::FieldExpansion::of({places.data(), places.size()}).value();
  ArrayDescription out{.positions_P_m = places,
                       .gradient = {},
                       .line = {},
                       .closure = static_cast<int>(expansion.closure_dof()),
                       .closure_limit = {},
                       .tells = what_it_tells(expansion)};
  if (out.closure > 0) out.closure_limit = closure_limit(out.closure);
  if (expansion.derivatives_along().size() == 1) out.line = expansion.derivatives_along().front().direction_P;
  for (std::size_t i = 0; i < expansion.determined().size(); ++i)
    if (expansion.determined()[i]) out.gradient.push_back(calibration::kGradientNames[i].substr(1));
  return out;
}

std::string array_name(const sensor::Geometry& array) {
  if (const auto baseline_m = array.cross_baseline_m())
    return fmt::format("the cross of four sensors, {:g} m from arm to arm", *baseline_m);
  return array.sensors() == 1 ? "one sensor" : fmt::format("an array of {} sensors", array.sensors());
}

std::pair<std::string, std::string> names_apart(const sensor::Geometry& a, const sensor::Geometry& b) {
  std::pair<std::string, std::string> out{array_name(a), array_name(b)};
  if (out.first != out.second) return out;
  constexpr double kRounded_m = 1e-6;
  const auto &own = a.positions_P_m(), &other = b.positions_P_m();
  std::size_t i = 0;
  while (i + 1 < own.size() && (own[i] - other[i]).norm() <= kRounded_m) ++i;
  out.first += fmt::format(" with s{} at {} m", i + 1, point_text(own[i], kRounded_m));
  out.second += fmt::format(" with s{} at {} m", i + 1, point_text(other[i], kRounded_m));
  return out;
}

}  // namespace mgtd::calib::report
