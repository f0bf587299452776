// SPDX-License-Identifier: Apache-2.0
#include "calib/poses/field_unit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace mgtd::calib::poses {
namespace {

std::string unit_name(double ratio) {
  const auto unit = field_unit_of(ratio);
  return unit ? std::string(unit->name) : std::string();
}

TEST(FieldUnit, EveryUnitIsKnownWithinAFactorOfThree) {
  const struct {
    double ratio;
    const char* unit;
  } kRows[] = {{1, ""},      {1e-9, "T"},  {1e-6, "mT"}, {1e-5, "G"},
               {1e-3, "uT"}, {1e-2, "mG"}, {1e3, "pT"},  {1e6, ""}};
  for (const auto& row : kRows)
    for (const double off : {1 / 3.0, 1.0, 3.0})
      EXPECT_EQ(unit_name(row.ratio * off), row.unit) << row.ratio * off;
  EXPECT_EQ(unit_name(0), "");
  EXPECT_EQ(unit_name(std::nan("")), "");
}

/// The factor turns the unit into nT.
TEST(FieldUnit, TheFactorIsThatOfTheUnit) {
  for (const double ratio : {1e-9, 1e-6, 1e-5, 1e-3, 1e-2, 1e3})
    EXPECT_NEAR(std::stod(std::string(field_unit_of(ratio)->factor)) * ratio, 1, 1e-9);
}

}  // namespace
}  // namespace mgtd::calib::poses
