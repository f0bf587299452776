// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration/apply.h"

#include <gmock/gmock.h>

#include "proto/units.h"
#include "tests/support/paper_rigs.h"

namespace mgtd::calib::calibration {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

Calibration true_calibration(const mgtd::testing::RigTruth& rig) {
  Calibration c;
  for (std::size_t i = 0; i < rig.size(); ++i) {
    sensor::ParameterVector p;
    for (int k = 0; k < sensor::kSensorParameters; ++k) {
      const bool is_angle = k <= sensor::psi || k >= sensor::alpha;
      const double shown = rig.at(i).at(static_cast<std::size_t>(k));
      p[k] = is_angle ? to_rad(shown) : shown;
    }
    c.sensors.at(i) = sensor::SensorModel::from_parameters(p);
  }
  c.seal();
  return c;
}

PoseTable clean_run() {
  return mgtd::testing::measure(mgtd::testing::table3_rig(), {50'000, 60, -5},
                                mgtd::testing::standard_run(20, 1), 36, {}, 1);
}

TEST(Apply, TrueParametersLeaveTheFieldAndNoGradient) {
  const auto rows = *apply(true_calibration(mgtd::testing::table3_rig()), clean_run());
  ASSERT_EQ(rows.size(), 56U);
  constexpr double kRounding_nT = 1e-8;  // a few bits of 50 000 nT
  for (const AppliedPose& row : rows) {
    EXPECT_NEAR(row.sample.f_nT, 50'000, kRounding_nT);
    EXPECT_NEAR(row.sample.g_nT_per_m.xz, 0, kRounding_nT / 0.4);
    EXPECT_LT(row.sample.closure.center_nT.norm(), kRounding_nT);
  }
}

TEST(Apply, ColumnsAreTheDocumentedOnes) {
  const std::string csv = format_applied(*apply(true_calibration(mgtd::testing::table3_rig()), clean_run()));
  EXPECT_THAT(csv, StartsWith("pose,t_s,s1_bx_nT,s1_by_nT,s1_bz_nT,s2_bx_nT"));
  EXPECT_THAT(csv, HasSubstr(",s4_bz_nT,Bx_nT,By_nT,Bz_nT,F_nT,Gxx_nT_per_m,Gyy_nT_per_m,Gzz_nT_per_m,"
                             "Gxy_nT_per_m,Gxz_nT_per_m,Gyz_nT_per_m,curl_nT_per_m,center_x_nT,center_y_nT,"
                             "center_z_nT\n1,0,"));
  EXPECT_THAT(csv, HasSubstr("\n56,825,"));
}

TEST(Apply, UncertaintyStandsBesideItWhereTheNoiseIsKnown) {
  Calibration c = true_calibration(mgtd::testing::table3_rig());
  c.sample_noise_nT.setConstant(2);
  PoseTable table = clean_run();
  for (Pose& pose : table.poses) pose.n_eff = 100;
  const auto averaged = *apply(c, table);
  for (Pose& pose : table.poses) pose.n_eff = 1;
  const auto single = *apply(c, table);
  // Without calibration covariance only the noise counts, and it averages.
  EXPECT_NEAR(single[3].sample.g_sd_nT_per_m.xx / averaged[3].sample.g_sd_nT_per_m.xx, 10, 1e-9);
  EXPECT_THAT(format_applied(averaged), HasSubstr("center_z_nT,Gxx_sd_nT_per_m,"));
  for (Pose& pose : table.poses) pose.t_s.reset();
  EXPECT_THAT(format_applied(*apply(c, table)), StartsWith("pose,s1_bx_nT"));
}

}  // namespace
}  // namespace mgtd::calib::calibration
