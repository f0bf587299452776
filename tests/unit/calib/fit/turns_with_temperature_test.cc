// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "calib/effects/library/library.h"
#include "tests/unit/calib/fit/fitted_arrays.h"

/// Angles that follow the temperature, where nothing tells the attitude: half of each pair of them is a turn
/// of the sensor. Its axes are not quite orthogonal, and by as much the turn is one of the gains too.
namespace mgtd::calib {
namespace {

using ::testing::HasSubstr;
using testing::Places;

constexpr const char* kWarmSpell =
    "[temperature]\npulse_degC = 12\npulse_at_s = 600\npulse_tau_s = 900\n"
    "[[effect]]\nname = \"axis.orthogonality.temperature\"\nwhere = \"s1.z\"\narcsec_per_degC = [6, -4]\n"
    "[[effect]]\nname = \"axis.orthogonality.temperature\"\nwhere = \"s1.y\"\narcsec_per_degC = [2, 1]\n";

PoseTable without_angles(PoseTable table) {
  for (Pose& pose : table.poses) pose.azimuth_rad = pose.pitch_rad = pose.roll_rad = std::nullopt;
  return table;
}

Result<fit::FitReport> fit_with(const PoseTable& table, const Places& places,
                                const std::vector<std::string>& specs) {
  fit::FitOptions options = testing::options_of(places);
  for (const std::string& spec : specs)
    options.effects.push_back(*effects::library::make_effect(spec, static_cast<int>(places.size())));
  return fit::method_choice::fit(table, options);
}

TEST(TurnsWithTemperature, OfALoneSensorTheAnglesBetweenTheAxesAreFound) {
  const Places one = testing::one_sensor();
  const auto report =
      fit_with(without_angles(testing::turned_run(one, 3, kWarmSpell)), one,
               {"axis.orthogonality.temperature@each-axis", "axis.orthogonality.temperature2@each-axis",
                "axis.gain.temperature@each-axis"});
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_NEAR(report->chi2 / report->dof, 1, 5 * std::sqrt(2 / report->dof));
  EXPECT_THAT(report->calibration.gauge, HasSubstr("how the sensor turns with its temperature is unknown"));
  std::map<std::string, calibration::EffectCoefficient> law;
  for (const auto& c : report->calibration.effects.front().coefficients) law[c.name] = c;
  const std::map<std::pair<std::string, std::string>, double> sums{
      {{"s1.zx", "s1.xz"}, 6}, {{"s1.zy", "s1.yz"}, -4 + 1}, {{"s1.yx", "s1.xy"}, 2}};
  for (const auto& [pair, expected] : sums) {
    const auto &a = law.at(pair.first), &b = law.at(pair.second);
    EXPECT_NEAR(a.value, b.value, 1e-3) << a.name;
    EXPECT_NEAR(a.value + b.value, expected, 5 * 2 * a.sd) << a.name;
    EXPECT_LT(a.sd, 0.5) << a.name;
  }
}

TEST(TurnsWithTemperature, OfSeveralSensorsThoseAgainstTheFirstAreFound) {
  const Places four = testing::cross_of_four();
  const std::string more =
      "[temperature]\npulse_degC = 12\npulse_at_s = 600\npulse_tau_s = 900\n"
      "[[effect]]\nname = \"platform.thermal-bending\"\nwhere = \"s3\"\narcsec_per_degC = [30, -20, 25]\n";
  const auto report =
      fit_with(without_angles(testing::turned_run(four, 4, more)), four, {"platform.thermal-bending"});
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_NEAR(report->chi2 / report->dof, 1, 5 * std::sqrt(2 / report->dof));
  EXPECT_THAT(report->calibration.gauge, HasSubstr("that of s1 is set to zero"));
  // Which way the platform lies is a convention without a table: of s3 the size of the turn counts.
  double square = 0, sd = 0;
  for (const auto& c : report->calibration.effects.front().coefficients) {
    if (c.name.starts_with("s3")) {
      square += c.value * c.value;
      sd = std::max(sd, c.sd);
    } else {
      EXPECT_NEAR(c.value, 0, 5 * c.sd + 1e-3) << c.name;
    }
  }
  EXPECT_NEAR(std::sqrt(square), std::sqrt(30 * 30 + 20 * 20 + 25 * 25), 5 * sd);
}

TEST(TurnsWithTemperature, WithATableTheyAreThoseOfTheSensor) {
  const Places one = testing::one_sensor();
  const auto report =
      fit_with(testing::turned_run(one, 3, kWarmSpell), one, {"axis.orthogonality.temperature@each-axis"});
  ASSERT_TRUE(report) << report.error().text();
  for (const auto& c : report->calibration.effects.front().coefficients) {
    const double expected = c.name == "s1.zx"   ? 6
                            : c.name == "s1.zy" ? -4
                            : c.name == "s1.yx" ? 2
                            : c.name == "s1.yz" ? 1
                                                : 0;
    EXPECT_NEAR(c.value, expected, 5 * c.sd) << c.name;
  }
}

}  // namespace
}  // namespace mgtd::calib
