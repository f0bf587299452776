// SPDX-License-Identifier: Apache-2.0
#include "calib/poses/field_unit.h"

#include <array>
#include <cmath>

namespace mgtd::calib::poses {
namespace {

constexpr double kSameUnit = 30;

struct Known {
  double ratio;
  FieldUnit unit;
};
constexpr std::array<Known, 6> kKnown{{{1e-9, {"T", "1000000000"}},
                                       {1e-6, {"mT", "1000000"}},
                                       {1e-5, {"G", "100000"}},
                                       {1e-3, {"uT", "1000"}},
                                       {1e-2, {"mG", "100"}},
                                       {1e3, {"pT", "0.001"}}}};

double apart(double a, double b) { return std::abs(std::log(a / b)); }

}  // namespace

std::optional<FieldUnit> field_unit_of(double ratio) {
  if (!(ratio > 0) || apart(ratio, 1) < std::log(kSameUnit)) return std::nullopt;
  const Known* nearest = kKnown.data();
  for (const Known& known : kKnown)
    if (apart(ratio, known.ratio) < apart(ratio, nearest->ratio)) nearest = &known;
  if (apart(ratio, nearest->ratio) > std::log(kSameUnit)) return std::nullopt;
  return nearest->unit;
}

}  // namespace mgtd::calib::poses
