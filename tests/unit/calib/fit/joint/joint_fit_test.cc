// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/joint_fit.h"
#include "calib/fit/checks/gauge_text.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "calib/effects/library/library.h"
#include "tests/unit/calib/fit/simulated_poses.h"

namespace mgtd::calib::fit::joint {
namespace {

using testing::Simulation;

Simulation real_rig() { return {.table_sd_rad = to_rad(0.1), .f_sd_nT = 0.05, .f_drift_nT = 30}; }

Eigen::VectorXd parameter_error(const JointFit& fit, const testing::Rig& truth) {
  Eigen::VectorXd e(FixedSlots{}.sensor_block());
  for (int i = 0; i < kSensors; ++i) {
    const auto s = static_cast<std::size_t>(i);
    e.segment<sensor::kSensorParameters>(sensor::kSensorParameters * i) =
        fit.state.sensors[s].parameters() - truth[s].parameters();
  }
  return e;
}

JointFit must_fit(const PoseTable& table, const JointOptions& options = {}) {
  auto fit = fit_joint(table, options);
  if (!fit) throw std::runtime_error(fit.error().text());
  return std::move(*fit);
}

TEST(JointFit, EstimatesTheTableAndTheNoise) {
  const PoseTable table = simulate(real_rig(), 36, 121, 1);
  const JointFit fit = must_fit(table);
  // 310 free attitude components: 4 % one sigma.
  EXPECT_NEAR(to_deg(fit.table_sd_rad), 0.1, 0.016);
  // 1525 degrees of freedom: 1.8 % one sigma.
  EXPECT_NEAR(fit.noise_nT(), 1.0, 0.08);
  EXPECT_TRUE(fit.outliers.empty());
  EXPECT_NE(
      checks::gauge_text(fit.gauge, 4, fit.table_sd_rad, fit.common_rotation_sd_rad).find("table angles"),
      std::string::npos);
}

/// The total field that --field gives to poses without one of their own is wrong by one error for them all.
TEST(JointFit, AKnownFieldIsOneObservationHoweverManyPosesTakeIt) {
  PoseTable table = simulate(real_rig(), 36, 121, 3);
  const double f_nT = *table.poses.front().f_nT;
  for (std::size_t k = 0; k < table.poses.size(); ++k) {
    if (k % 8 == 0) {
      table.poses[k].f_sd_nT = 10;
    } else {
      table.poses[k].f_nT = table.poses[k].f_sd_nT = std::nullopt;
    }
  }
  const JointFit fit = must_fit(table, {.field_nT = f_nT + 20, .field_sd_nT = 20});
  const int slot = sensor::cx;
  const double sd_nT = std::sqrt(fit.covariance(slot, slot)) * f_nT;
  const double error_nT = (fit.state.sensors[0].scale[0] / real_rig().rig[0].scale[0] - 1) * f_nT;
  EXPECT_GT(std::abs(error_nT), 5);
  EXPECT_LT(std::abs(error_nT), 2 * sd_nT);
  EXPECT_LT(sd_nT, 21);
}

TEST(JointFit, ThatIsToldToStopIsRefused) {
  std::stop_source stop;
  JointOptions options;
  options.stop = stop.get_token();
  const PoseTable table = simulate(real_rig(), 36, 121, 1);
  ASSERT_TRUE(fit_joint(table, options));
  stop.request_stop();
  const auto fit = fit_joint(table, options);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, ErrorCode::state) << fit.error().text();
}

TEST(JointFit, TellsEachRoundAndTheResidualItLeft) {
  JointOptions options;
  std::vector<FitRound> told;
  options.on_round = [&](const FitRound& round) { told.push_back(round); };
  const JointFit fit = must_fit(simulate(real_rig(), 36, 121, 1), options);
  ASSERT_EQ(static_cast<int>(told.size()), fit.rounds);
  EXPECT_EQ(told.front().round, 1);
  EXPECT_EQ(told.back().round, fit.rounds);
  EXPECT_NEAR(told.back().residual_nT, fit.noise_nT(), 0.05);
}

TEST(JointFit, ReportedCovarianceIsTheRealOne) {
  // Normalised estimation error squared: mean of 60 chi-squares with 48 degrees of freedom, 99.9 % band.
  constexpr int kRuns = 60;
  double sum = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Simulation sim = real_rig();
    const PoseTable table = simulate(sim, 36, 121, 100 + static_cast<std::uint64_t>(run));
    const JointFit fit = must_fit(table);
    const Eigen::VectorXd e = parameter_error(fit, sim.rig);
    sum += e.dot(fit.covariance.topLeftCorner(FixedSlots{}.sensor_block(), FixedSlots{}.sensor_block())
                     .llt()
                     .solve(e));
  }
  const double sd = std::sqrt(2.0 * FixedSlots{}.sensor_block() / kRuns);
  EXPECT_NEAR(sum / kRuns, FixedSlots{}.sensor_block(), 3.29 * sd);
}

TEST(JointFit, GradientOfTheSiteIsFoundWithItsUncertainty) {
  Simulation sim = real_rig();
  sim.G_nT_per_m = testing::gradient_50();
  const PoseTable table = simulate(sim, 36, 121, 5);
  JointOptions options;
  options.effects = {*effects::library::make_effect("site.gradient")};
  const JointFit fit = must_fit(table, options);
  const auto& G = sim.G_nT_per_m;
  const Eigen::Matrix<double, 5, 1> truth{G(0, 0), G(1, 1), G(0, 1), G(0, 2), G(1, 2)};
  const Eigen::VectorXd e = fit.state.coefficients - truth;
  const Eigen::MatrixXd C = fit.covariance.bottomRightCorner(5, 5);
  EXPECT_LT(e.dot(C.llt().solve(e)), 20.5);  // 99.9 % of chi-square with 5 degrees of freedom
  EXPECT_LT(std::sqrt(C.diagonal().maxCoeff()), 1.0);
  EXPECT_LT(fit.chi2, fit.dof + 3.3 * std::sqrt(2 * fit.dof));
  // Without it the misfit shows.
  const JointFit without = must_fit(table);
  EXPECT_GT(without.noise_nT(), 2);
}

TEST(JointFit, EveryMountingIsFound) {
  Simulation sim = real_rig();
  int mirrored = 0;
  for (int m = 0; m < 48; ++m) {
    Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
    constexpr int kPermutations[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (int j = 0; j < 3; ++j) M(kPermutations[m / 8][j], j) = (m >> j & 1) != 0 ? -1 : 1;
    mirrored += M.determinant() < 0 ? 1 : 0;
    sim.rig[2].mounting = M;
    const PoseTable table = simulate(sim, 12, 40, 7);
    const JointFit fit = must_fit(table);
    EXPECT_EQ(fit.state.sensors[2].mounting, M) << "mounting " << m;
    EXPECT_EQ(fit.state.sensors[0].mounting, Eigen::Matrix3d(Eigen::Matrix3d::Identity()));
    EXPECT_LT(fit.noise_nT(), 1.5);
  }
  EXPECT_EQ(mirrored, 24);
}

TEST(JointFit, OffsetsLargerThanTheFieldConverge) {
  Simulation sim = real_rig();
  for (std::size_t i = 0; i < kSensors; ++i)
    sim.rig[i].offset_nT = Eigen::Vector3d{150'000, -120'000, 90'000} * (i % 2 == 0 ? 1 : -1);
  const JointFit fit = must_fit(simulate(sim, 36, 121, 9));
  const Eigen::VectorXd e = parameter_error(fit, sim.rig);
  EXPECT_LT(e.dot(fit.covariance.topLeftCorner(FixedSlots{}.sensor_block(), FixedSlots{}.sensor_block())
                      .llt()
                      .solve(e)),
            48 + 3.3 * std::sqrt(96));
}

TEST(JointFit, BadPosesBecomeListedNodes) {
  const Simulation sim = real_rig();
  PoseTable table = simulate(sim, 36, 121, 11);
  table.poses[40].y_nT[2][1] += 300;
  table.poses[90].y_nT[0] += Eigen::Vector3d{2000, -1000, 500};
  *table.poses[100].f_nT += 40;
  *table.poses[120].azimuth_rad += to_rad(3);
  const JointFit fit = must_fit(table);
  std::vector<std::string> found;
  for (const OutlierNode& node : fit.outliers) found.push_back(std::to_string(node.pose) + " " + node.where);
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, (std::vector<std::string>{"101 scalar", "121 angles", "41 s3.y", "91 s1"}));
  for (const OutlierNode& node : fit.outliers) {
    if (node.where == "s3.y") {
      EXPECT_NEAR(node.shift, 300, 5);
    }
    if (node.where == "scalar") {
      EXPECT_NEAR(node.shift, 40, 3);
    }
    if (node.where == "angles") {
      EXPECT_NEAR(node.shift, 3, 0.5);
    }
  }
  const Eigen::VectorXd e = parameter_error(fit, sim.rig);
  EXPECT_LT(e.dot(fit.covariance.topLeftCorner(FixedSlots{}.sensor_block(), FixedSlots{}.sensor_block())
                      .llt()
                      .solve(e)),
            48 + 3.3 * std::sqrt(96));
}

TEST(JointFit, OneReadingHoweverWildCostsNoOther) {
  const Simulation sim = real_rig();
  for (const double off_nT : {20.0, 1'000.0, 30'000.0}) {
    for (const std::size_t at : {29U, 82U}) {
      PoseTable table = simulate(sim, 36, 121, 11);
      table.poses[at].y_nT[0][0] += off_nT;
      const JointFit fit = must_fit(table);
      ASSERT_EQ(fit.outliers.size(), 1U) << off_nT << " nT, pose " << at + 1;
      EXPECT_EQ(fit.outliers.front().where, "s1.x");
      EXPECT_NEAR(fit.outliers.front().shift, off_nT, 10);
      EXPECT_NEAR(to_deg(fit.table_sd_rad), 0.1, 0.02);
    }
  }
}

TEST(JointFit, WithoutAnglesTheCommonRotationIsConvention) {
  Simulation sim = real_rig();
  sim.with_angles = false;
  sim.rig[1].mounting << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const JointFit fit = must_fit(simulate(sim, 36, 121, 13));
  EXPECT_EQ(fit.gauge.constraints, 3);
  EXPECT_EQ(fit.state.sensors[1].mounting, sim.rig[1].mounting);
  EXPECT_LT(fit.chi2, fit.dof + 3.3 * std::sqrt(2 * fit.dof));
  EXPECT_NE(
      checks::gauge_text(fit.gauge, 4, fit.table_sd_rad, fit.common_rotation_sd_rad).find("no table angles"),
      std::string::npos);
}

TEST(JointFit, WithoutAFieldTheScaleIsConvention) {
  Simulation sim = real_rig();
  sim.with_f = false;
  sim.f_drift_nT = 0;
  const PoseTable table = simulate(sim, 36, 121, 15);
  const JointFit fit = must_fit(table);
  double mean = 0;
  for (const sensor::SensorModel& s : fit.state.sensors) mean += s.scale.sum() / sensor::kChannels;
  EXPECT_NEAR(mean, 1, 1e-6);
  EXPECT_NE(
      checks::gauge_text(fit.gauge, 4, fit.table_sd_rad, fit.common_rotation_sd_rad).find("scale is free"),
      std::string::npos);
  // Given the field, the truth comes back.
  JointOptions options;
  options.field_nT = sim.f_nT;
  const JointFit known = must_fit(table, options);
  const Eigen::VectorXd e = parameter_error(known, sim.rig);
  EXPECT_LT(e.dot(known.covariance.topLeftCorner(FixedSlots{}.sensor_block(), FixedSlots{}.sensor_block())
                      .llt()
                      .solve(e)),
            48 + 3.3 * std::sqrt(96));
}

TEST(JointFit, StandardAnglesOnlyLeaveTheAzimuthOpen) {
  Simulation sim = real_rig();
  PoseTable table = simulate(sim, 36, 121, 17);
  for (Pose& pose : table.poses) {
    if (pose.set != "standard") pose.azimuth_rad = pose.pitch_rad = pose.roll_rad = std::nullopt;
  }
  const JointFit fit = must_fit(table);
  EXPECT_EQ(fit.gauge.angles, AngleCoverage::one_axis);
  double mean = 0;
  for (const sensor::SensorModel& s : fit.state.sensors) mean += s.gamma_rad / kSensors;
  EXPECT_NEAR(mean, 0, 1e-6);
  EXPECT_LT(fit.noise_nT(), 1.15);
  JointOptions options;
  options.inclination_rad = sim.inclination_rad;
  options.declination_rad = sim.declination_rad;
  const JointFit given = must_fit(table, options);
  const Eigen::VectorXd e = parameter_error(given, sim.rig);
  EXPECT_LT(e.dot(given.covariance.topLeftCorner(FixedSlots{}.sensor_block(), FixedSlots{}.sensor_block())
                      .llt()
                      .solve(e)),
            48 + 3.3 * std::sqrt(96));
}

TEST(JointFit, OneAxisIsRefused) {
  const auto fit = fit_joint(simulate(real_rig(), 36, 0, 19), {});
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.error().remedy.find("axis"), std::string::npos) << fit.error().text();
}

TEST(JointFit, GradientWithoutAnglesIsRefused) {
  Simulation sim = real_rig();
  sim.with_angles = false;
  JointOptions options;
  options.effects = {*effects::library::make_effect("site.gradient")};
  const auto fit = fit_joint(simulate(sim, 36, 50, 19), options);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, ErrorCode::refused);
}

}  // namespace
}  // namespace mgtd::calib::fit::joint
