// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/formula/parser_functions.h"

#include <muParser.h>

#include <cmath>
#include <numbers>

namespace mgtd::calib::effects::formula {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180;
double sind(double deg) { return std::sin(deg * kRadiansPerDegree); }
double cosd(double deg) { return std::cos(deg * kRadiansPerDegree); }
double tand(double deg) { return std::tan(deg * kRadiansPerDegree); }

}  // namespace

void define_functions(mu::Parser& parser) {
  parser.DefineConst("pi", std::numbers::pi);
  parser.DefineFun("sind", sind);
  parser.DefineFun("cosd", cosd);
  parser.DefineFun("tand", tand);
}

}  // namespace mgtd::calib::effects::formula
