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

/// All parsers share one locale, and the first number that any of them reads fills a cache in it, which the
/// standard library then reads without a lock. So the first one is read here, before two threads can be at
/// it.
void read_the_first_number() {
  [[maybe_unused]] static const double first = [] {
    mu::Parser parser;
    parser.SetExpr("0.5");
    return parser.Eval();
  }();
}

}  // namespace

void define_functions(mu::Parser& parser) {
  read_the_first_number();
  parser.DefineConst("pi", std::numbers::pi);
  parser.DefineFun("sind", sind);
  parser.DefineFun("cosd", cosd);
  parser.DefineFun("tand", tand);
}

}  // namespace mgtd::calib::effects::formula
