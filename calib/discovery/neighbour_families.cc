// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/neighbour_families.h"

#include <fmt/format.h>

#include "calib/effects/effect_context.h"

namespace mgtd::calib::discovery {
namespace {

void neighbour(int sensor, std::vector<std::string> covariates, int symbols, const std::string& text,
               GrammarWriter& out) {
  Family& family = out.add(std::move(covariates), symbols, {text});
  family.foreign_sensor = sensor;
  family.whole_array = false;
  family.of_site = false;
}

}  // namespace

void write_neighbour_families(GrammarWriter& out) {
  const LawInputs& inputs = out.inputs();
  for (int s = 0; s < inputs.channels() / 3 && inputs.channels() > 3; ++s) {
    for (int axis = 0; axis < 3; ++axis) {
      const int channel = 3 * s + axis;
      const std::string name = fmt::format("s{}_{}_nT", s + 1, "xyz"[axis]);
      const double offset_nT = inputs.name(name, channel)[0] - inputs.name("u", channel)[0];
      const std::string x =
          fmt::format("(({})/{})", less_text(name, offset_nT), number_text(effects::kReferenceField_nT));
      for (const std::string& text :
           {fmt::format("abs({})", x), x + "^2", x + "^3", fmt::format("sign({})", x)})
        neighbour(s, {name}, 4, text, out);
      const std::string T = fmt::format("s{}_T_degC", s + 1);
      if (const Scalar* own = out.scalars().find(T))
        neighbour(s, {name, T}, 5, x + "*" + own->about(own->mean), out);
    }
  }
}

}  // namespace mgtd::calib::discovery
