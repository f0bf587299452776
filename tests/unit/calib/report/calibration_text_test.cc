// SPDX-License-Identifier: Apache-2.0
#include "calib/report/calibration_text.h"

#include <gmock/gmock.h>

#include <sstream>

namespace mgtd::calib::report {
namespace {

using ::testing::HasSubstr;

calibration::Calibration four_sensors() {
  calibration::Calibration c;
  c.method = "joint";
  c.id = "c0123456789ab";
  c.poses = 157;
  c.gauge = "mean of alpha, beta, gamma is zero";
  c.sensors.resize(4);
  c.sensors[2].offset_nT.z() = 12.345;
  c.covariance.diagonal().setConstant(1e-8);
  c.checks.push_back(
      {.name = "residual", .passed = false, .measured = "2 nT", .limit = "1 nT", .remedy = "look"});
  c.effects.push_back({"site.gradient", {{"Gxx", 123.4, 0.5, "nT/m"}}, {}});
  return c;
}

std::size_t longest_line(const std::string& text) {
  std::size_t out = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) out = std::max(out, seen_width(line));
  return out;
}

TEST(CalibrationText, SaysWhatItIsAndWhetherItWasAccepted) {
  auto c = four_sensors();
  EXPECT_EQ(calibration_heading(c), "joint calibration c0123456789ab of 157 poses: NOT ACCEPTED\n");
  c.accepted_by_checks = true;
  EXPECT_THAT(to_text(c), HasSubstr("of 157 poses: accepted by its checks\n"));
}

TEST(CalibrationText, ShowsParametersEffectsAndChecks) {
  const std::string text = to_text(four_sensors());
  EXPECT_THAT(text, HasSubstr("12.34500 ± 0.00010"));
  EXPECT_THAT(text, HasSubstr("site.gradient Gxx"));
  EXPECT_THAT(text, HasSubstr("123.40 ± 0.50 nT/m"));
  EXPECT_THAT(text, HasSubstr("  FAIL  residual             2 nT (limit 1 nT)\n        -> look\n"));
}

TEST(CalibrationText, ATinyCoefficientIsNoRowOfZeros) {
  EXPECT_EQ(with_sd(2.5e-14, 3e-15), "2.5e-14 ± 3e-15");
  EXPECT_EQ(with_sd(2.5, 3e-4), "2.50000 ± 0.00030");
}

TEST(CalibrationText, AFormulaStandsOnceAboveItsCoefficients) {
  calibration::Calibration c = four_sensors();
  const std::string lift = "lift,level=gradient,expr=k1*t_h + k2*t_h^2";
  c.effects.push_back({lift, {{"Gxx.k1", 25, 0.5, "nT/m"}, {"Gxx.k2", 3, 0.5, "nT/m"}}, {}});
  c.effects.push_back({"dip@s1.x,expr=t_h", {{"s1.x", 2, 0.5, "nT"}}, {}});
  const std::string text = to_text(c);
  EXPECT_EQ(text.find(lift), text.rfind(lift));
  EXPECT_THAT(text, HasSubstr(lift + "\n  Gxx.k1 "));
  EXPECT_THAT(text, HasSubstr("dip@s1.x,expr=t_h s1.x "));
}

TEST(CalibrationText, TheTableOfParametersKeepsToTheWidth) {
  const auto c = four_sensors();
  for (const std::size_t width : {60U, 80U, 100U, 120U})
    EXPECT_LE(longest_line(parameter_table(c, width)), width);
  for (const char* sensor : {"s1", "s2", "s3", "s4"}) EXPECT_THAT(parameter_table(c, 60), HasSubstr(sensor));
}

}  // namespace
}  // namespace mgtd::calib::report
