// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/reading_families.h"

#include <fmt/format.h>

#include <algorithm>

#include "calib/discovery/formula_parts.h"
#include "calib/effects/effect_context.h"

namespace mgtd::calib::discovery {
namespace {

/// Where a curve of the reading may have a bend or a step, over the field: shares of the largest reading.
std::vector<double> knots(const LawInputs& inputs) {
  double most = 0;
  for (int c = 0; c < inputs.channels(); ++c)
    most = std::max(most, inputs.name("u", c).cwiseAbs().maxCoeff() / effects::kReferenceField_nT);
  std::vector<double> out;
  for (const double share : {-0.7, -0.5, -0.3, -0.1, 0.1, 0.3, 0.5, 0.7}) out.push_back(share * most);
  return out;
}

void own_readings(GrammarWriter& out) {
  const std::vector<double> at = knots(out.inputs());
  const std::vector<double> sizes(at.begin() + 4, at.end());
  for (const std::string& name : kReadings) {
    const std::string x = over_field(name);
    for (int power = 2; power <= (name == "u" ? 6 : 4); ++power)
      out.of_reading(name, power < 4 ? 2 : power == 4 ? 3 : 4, {fmt::format("{}^{}", x, power)});
    out.of_reading(name, 2, {fmt::format("abs({})", x)});
    out.of_reading(name, 2, {fmt::format("sign({})", x)});
    out.of_reading(name, 3, {fmt::format("{}*abs({})", x, x)});
    if (name != "u") continue;
    out.of_reading(name, 3, ratios(0.03, 0.6, 8),
                   [x](double w) { return Columns{fmt::format("tanh({}/{})", x, number_text(w))}; });
    out.of_reading(name, 3, at,
                   [x](double c) { return Columns{fmt::format("max(0, {})", less_text(x, c))}; });
    out.of_reading(name, 3, at, [x](double c) { return Columns{fmt::format("({}>{})", x, number_text(c))}; });
    out.of_reading(name, 4, sizes,
                   [x](double c) { return Columns{fmt::format("max(0, abs({})-{})", x, number_text(c))}; });
  }
}

void axes_together(GrammarWriter& out) {
  for (std::size_t a = 0; a < 3; ++a) {
    const std::string xa = over_field(kAxes[a]);
    for (std::size_t b = 0; b < 3; ++b) {
      if (b == a) continue;
      const std::string xb = over_field(kAxes[b]);
      if (b > a) out.of_readings({kAxes[a], kAxes[b]}, 3, {xa + "*" + xb});
      out.of_readings({kAxes[a], kAxes[b]}, 4, {xa + "^2*" + xb});
    }
  }
  out.of_readings({kAxes[0], kAxes[1], kAxes[2]}, 5,
                  {fmt::format("{}*{}*{}", over_field("ux"), over_field("uy"), over_field("uz"))});
}

void pose_before(GrammarWriter& out) {
  for (const std::string& own : kReadings) {
    const std::string name = "prev_" + own, x = over_field(name);
    out.of_reading(name, 2, {x});
    out.of_reading(name, 3, {fmt::format("abs({})", x)});
    out.of_reading(name, 3, {x + "^2"});
    out.of_reading(name, 3, {fmt::format("sign({})", x)});
  }
  out.of_reading("prev_u", 4, {fmt::format("{}*{}", over_field("prev_u"), over_field("u"))});
  out.of_reading("prev_u", 4, {fmt::format("abs(prev_u-u)/{}", number_text(effects::kReferenceField_nT))});
}

}  // namespace

void write_reading_families(GrammarWriter& out) {
  own_readings(out);
  axes_together(out);
  pose_before(out);
}

}  // namespace mgtd::calib::discovery
