// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/formula_text.h"

#include <gmock/gmock.h>

#include "calib/discovery/grammar.h"

namespace mgtd::calib::discovery {
namespace {

using ::testing::ElementsAre;

constexpr Place kAxis{Place::Kind::axis, 5}, kSensor{Place::Kind::sensor, 2}, kArray{Place::Kind::array, 0};

TEST(FormulaText, ReadsAsAPersonWritesIt) {
  EXPECT_EQ(shown({"(u/50000)^2"}, kAxis), "z^2");
  EXPECT_EQ(shown({"(u/50000)^2"}, kSensor), "u^2");
  EXPECT_EQ(shown({"(prev_u/50000)*(uy/50000)"}, kAxis), "prev_z*y");
  EXPECT_EQ(shown({"max(0, (T_degC-24.1))"}, kAxis), "max(0, (T-24.1))");
  EXPECT_EQ(shown({"lag600_s3_T_degC"}, kAxis), "lag(s3_T, 600 s)");
  EXPECT_EQ(shown({"abs(((s2_x_nT-12.3)/50000))"}, kAxis), "abs(s2_x)");
  EXPECT_EQ(shown({kGravity[1]}, kAxis), "gy");
  EXPECT_EQ(shown({"sind(1*azimuth_deg)", "cosd(1*azimuth_deg)"}, kAxis),
            "a*sind(azimuth_deg) + b*cosd(azimuth_deg)");
}

TEST(FormulaText, CovariatesAreCalledAsInThePoseTable) {
  EXPECT_EQ(shown_covariate("T_degC", kAxis), "s2_T_degC");
  EXPECT_EQ(shown_covariate("T_degC", kArray), "T_degC");
  EXPECT_EQ(shown_covariate("u", kAxis), "s2.z");
  EXPECT_EQ(shown_covariate("prev_ux", kSensor), "s3.x before");
  EXPECT_EQ(shown_covariate("battery_V", kAxis), "battery_V");
}

TEST(FormulaText, ALawOfASensorIsOneEffectAnAxis) {
  EXPECT_THAT(specs_of({"T_degC"}, kAxis, "law1"), ElementsAre("law1@s2.z,level=axis,unit=nT,expr=T_degC"));
  EXPECT_EQ(specs_of({"T_degC"}, kSensor, "law1").size(), 3U);
  EXPECT_THAT(specs_of({"a_A", "b_V"}, kArray, "law1"),
              ElementsAre("law1@each-axis,level=axis,unit=nT,expr=k1*a_A + k2*b_V"));
  EXPECT_THAT(specs_of({"t_h"}, {Place::Kind::gradient, 0}, "law1"),
              ElementsAre("law1,level=gradient,unit=nT/m,expr=t_h"));
  EXPECT_THAT(specs_of({"a_A", "b_V", "c_A"}, {Place::Kind::gradient, 0}, "law1"),
              ElementsAre("law1-1,level=gradient,unit=nT/m,expr=k1*a_A + k2*b_V",
                          "law1-2,level=gradient,unit=nT/m,expr=c_A"))
      << "a gradient takes two coefficients";
}

}  // namespace
}  // namespace mgtd::calib::discovery
