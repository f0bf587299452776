// SPDX-License-Identifier: Apache-2.0
#include "calib/sensor/sensor_model.h"

#include <gtest/gtest.h>

#include "proto/units.h"

namespace mgtd::calib::sensor {
namespace {

SensorModel table3_sensor1() {
  return {.theta_rad = to_rad(-1.9),
          .phi_rad = to_rad(1.6),
          .psi_rad = to_rad(2.3),
          .scale = {0.988, 1.105, 1.054},
          .offset_nT = {234, 114, -218},
          .alpha_rad = to_rad(2.5),
          .beta_rad = to_rad(-2.2),
          .gamma_rad = to_rad(1.7)};
}

TEST(SensorModel, CorrectInvertsPredict) {
  const SensorModel model = table3_sensor1();
  const Eigen::Vector3d b_P_nT{21'000, -17'000, 43'000};
  // 5e4 nT times the machine epsilon times a few operations.
  EXPECT_LT((model.correct(model.predict(b_P_nT)) - b_P_nT).norm(), 1e-9);
}

TEST(SensorModel, RotationIsEquation14) {
  // Rows Tz and Ty of eqs. 16-18 written out.
  const SensorModel m = table3_sensor1();
  const double a = m.alpha_rad, b = m.beta_rad, g = m.gamma_rad;
  const Eigen::Matrix3d R = m.R_PS();
  EXPECT_NEAR(R(2, 0), std::sin(b), 1e-15);
  EXPECT_NEAR(R(2, 1), -std::sin(a) * std::cos(b), 1e-15);
  EXPECT_NEAR(R(2, 2), std::cos(a) * std::cos(b), 1e-15);
  EXPECT_NEAR(R(1, 0), -std::cos(b) * std::sin(g), 1e-15);
  EXPECT_NEAR(R(1, 1), std::cos(a) * std::cos(g) - std::sin(a) * std::sin(b) * std::sin(g), 1e-15);
  EXPECT_NEAR(R(1, 2), std::sin(a) * std::cos(g) + std::cos(a) * std::sin(b) * std::sin(g), 1e-15);
}

TEST(SensorModel, ParametersRoundTrip) {
  const SensorModel m = table3_sensor1();
  EXPECT_EQ(SensorModel::from_parameters(m.parameters()).parameters(), m.parameters());
}

}  // namespace
}  // namespace mgtd::calib::sensor
