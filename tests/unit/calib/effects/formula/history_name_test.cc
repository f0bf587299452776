// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/formula/history_name.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mgtd::calib::effects::formula {
namespace {

TEST(HistoryName, IsReadFromItsParts) {
  EXPECT_EQ(history_name("prev_ux")->of, "ux");
  EXPECT_EQ(history_name("rate_s2_T_degC")->kind, HistoryName::Kind::rate);
  const auto lag = history_name("lag600_T_degC");
  ASSERT_TRUE(lag);
  EXPECT_EQ(lag->kind, HistoryName::Kind::lag);
  EXPECT_EQ(lag->tau_s, 600);
  EXPECT_EQ(lag->of, "T_degC");
  EXPECT_EQ(history_name("prev_s3_x_nT")->of, "s3_x_nT");
  EXPECT_EQ(history_name("lag60_lamp_A")->of, "lamp_A");
  // Columns of the user's own.
  for (const char* other : {"lamp_A", "lag_T", "lag0_T_degC", "lagging", "T_degC", "rate_hz", "prev_pose",
                            "rate_u", "rate_s_T_degC", "prev_sx_T_degC"})
    EXPECT_FALSE(history_name(other)) << other;
}

TEST(HistoryName, BeforeTheFirstPoseThereIsNothing) {
  const auto before =
      history(*history_name("prev_u"), std::vector<double>{0, 1, 2}, std::vector<double>{5, 6, 7});
  EXPECT_TRUE(std::isnan(before[0]));
  EXPECT_EQ(before[1], 5);
  EXPECT_EQ(before[2], 6);
}

/// dz/dt = (X - z)/tau for X = t from rest is t - tau (1 - exp(-t/tau)).
TEST(HistoryName, ALagIsTheLowPassOfARamp) {
  std::vector<double> t, x;
  for (int k = 0; k < 40; ++k) t.push_back(0.02 * k), x.push_back(0.02 * k);
  const auto z = history(*history_name("lag600_X"), t, x);
  const double tau = 600.0 / 3600;
  for (std::size_t k = 0; k < t.size(); ++k)
    EXPECT_NEAR(z[k], t[k] - tau * (1 - std::exp(-t[k] / tau)), 1e-12);
}

TEST(HistoryName, ARateIsTheSlopeAnHour) {
  std::vector<double> t, x;
  for (int k = 0; k < 30; ++k) t.push_back(0.01 * k * (1 + 0.1 * (k % 3))), x.push_back(3 - 4 * t.back());
  for (const double slope : history(*history_name("rate_T_degC"), t, x)) EXPECT_NEAR(slope, -4, 1e-9);
}

}  // namespace
}  // namespace mgtd::calib::effects::formula
