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

}  // namespace mgtd::calib::report
