// SPDX-License-Identifier: Apache-2.0
#include "calib/design/experiment_design.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib/effects/library/library.h"
#include "calib/fit/joint/field_uncertainty.h"
#include "calib/fit/joint/joint_fit.h"
#include "calib/report/experiment_design_report.h"
#include "tests/unit/calib/fit/fitted_arrays.h"
#include "tests/unit/calib/fit/simulated_poses.h"

namespace mgtd::calib::design {
namespace {

using testing::Simulation;

DesignRequest request_of(const PoseTable& table, const Simulation& sim) {
  DesignRequest request;
  request.f_nT = sim.f_nT;
  request.inclination_rad = sim.inclination_rad;
  request.declination_rad = sim.declination_rad;
  request.pose_noise_nT = sim.noise_nT;
  request.sensors = sim.rig;
  request.poses = table;
  return request;
}

double fitted_sd(const fit::joint::JointFit& fit, const Expected& e, int slot) {
  return std::sqrt(fit.covariance(slot, slot)) / (e.unit == "deg" ? kRadiansPerDegree : 1);
}

TEST(Plan, ForetellsWhatTheFitThenReports) {
  const Simulation sim{.table_sd_rad = to_rad(0.1), .f_sd_nT = 0.05};
  const PoseTable table = simulate(sim, 36, 121, 3);
  const auto foretold = evaluate_design(request_of(table, sim));
  ASSERT_TRUE(foretold) << foretold.error().text();
  ASSERT_TRUE(foretold->determined);
  const auto fit = fit::joint::fit_joint(table, {});
  ASSERT_TRUE(fit);
  for (int p = 0; p < fit::joint::FixedSlots{}.sensor_block(); ++p) {
    const Expected& e = foretold->parameters[static_cast<std::size_t>(p)];
    // The fit estimates noise and table from the data: each axis to 7 %, the table to 4 %.
    EXPECT_NEAR(e.sd / fitted_sd(*fit, e, p), 1, 0.25) << e.name;
  }
  EXPECT_NEAR(foretold->noise_sd_nT_per_m.xx, std::sqrt(2.0) / 0.4, 1e-9);
  EXPECT_LT(foretold->tensor_sd_nT_per_m.xx, 1);
  ASSERT_FALSE(foretold->helpful.empty());
  EXPECT_GT(foretold->helpful.front().share, 0);
  EXPECT_TRUE(foretold->separations.empty());
}

TEST(Plan, ForetoldErrorsAreTheRealOnes) {
  // 80 runs at the same attitudes. A mean square of 80 Gaussian errors scatters by sqrt(2/80) = 16 %: of 53
  // ratios of standard errors none leaves 1 +- 4 x 8 %, and their mean square, some 25 independent ones,
  // stays within 1 +- 4 x 3.2 %.
  constexpr int kRuns = 80;
  Simulation sim{.table_sd_rad = to_rad(0.1), .f_sd_nT = 0.05};
  sim.G_nT_per_m = testing::gradient_50();
  const auto& G = sim.G_nT_per_m;
  const std::array<double, 5> truth{G(0, 0), G(1, 1), G(0, 1), G(0, 2), G(1, 2)};
  fit::joint::JointOptions options;
  options.effects = {*effects::library::make_effect("site.gradient")};
  std::mt19937_64 rng(71);
  const PoseTable first = simulate(sim, 18, 82, 70);
  DesignRequest request = request_of(first, sim);
  request.effects = options.effects;
  const auto foretold = evaluate_design(request);
  ASSERT_TRUE(foretold) << foretold.error().text();
  ASSERT_EQ(foretold->parameters.size(), 53U);
  std::vector<double> sum(53, 0);
  for (int run = 0; run < kRuns; ++run) {
    PoseTable table;
    for (const Pose& pose : first.poses)
      table.poses.push_back(measure(sim, *pose.angles(), pose.number, 0, rng));
    const auto fit = fit::joint::fit_joint(table, options);
    ASSERT_TRUE(fit);
    const auto sensor_block = static_cast<std::size_t>(fit::joint::FixedSlots{}.sensor_block());
    for (std::size_t j = 0; j < sum.size(); ++j) {
      const auto s = j / sensor::kSensorParameters;
      const auto p = static_cast<Eigen::Index>(j % sensor::kSensorParameters);
      const double error = j < sensor_block
                               ? fit->state.sensors[s].parameters()[p] - sim.rig[s].parameters()[p]
                               : fit->state.coefficients[static_cast<Eigen::Index>(j - sensor_block)] -
                                     truth[j - sensor_block];
      const double sd =
          foretold->parameters[j].sd * (foretold->parameters[j].unit == "deg" ? kRadiansPerDegree : 1);
      sum[j] += error * error / (sd * sd) / kRuns;
    }
  }
  double mean = 0;
  for (std::size_t j = 0; j < sum.size(); ++j) {
    EXPECT_NEAR(std::sqrt(sum[j]), 1, 0.32) << foretold->parameters[j].name;
    mean += sum[j] / 53;
  }
  EXPECT_NEAR(mean, 1, 0.13);
}

TEST(Plan, LevelTurnAloneIsNotDetermined) {
  const Simulation sim;
  DesignRequest request = request_of(simulate(sim, 36, 0, 3), sim);
  const auto foretold = evaluate_design(request);
  ASSERT_TRUE(foretold) << foretold.error().text();
  EXPECT_FALSE(foretold->determined);
  ASSERT_FALSE(foretold->known.weak.empty());
  ASSERT_FALSE(foretold->known.add.empty());
  // Following the advice, a few times, determines it.
  for (int round = 0; round < 3; ++round) {
    const auto again = evaluate_design(request);
    for (const TableAngles& a : again->known.add) {
      Pose pose;
      pose.number = static_cast<int>(request.poses.poses.size()) + 1;
      pose.azimuth_rad = a.azimuth_rad;
      pose.pitch_rad = a.pitch_rad;
      pose.roll_rad = a.roll_rad;
      request.poses.poses.push_back(pose);
    }
  }
  EXPECT_TRUE(evaluate_design(request)->determined);
}

TEST(Plan, GradientCostsLittleAndIsForetold) {
  const Simulation sim;
  DesignRequest request = request_of(simulate(sim, 36, 121, 5), sim);
  request.effects = {*effects::library::make_effect("site.gradient")};
  const auto foretold = evaluate_design(request);
  ASSERT_TRUE(foretold) << foretold.error().text();
  EXPECT_EQ(foretold->parameters.back().name, "site.gradient Gyz");
  EXPECT_LT(foretold->parameters.back().sd, 1);
  EXPECT_GT(foretold->parameters.back().sd, 0.05);
  ASSERT_EQ(foretold->separations.size(), 5U);
  for (const Separation& s : foretold->separations) EXPECT_GE(s.inflation, 1 - 1e-9) << s.name;
}

TEST(Plan, WithoutAFieldTheScaleIsFree) {
  const Simulation sim;
  DesignRequest request = request_of(simulate(sim, 36, 60, 5), sim);
  request.scalar_sd_nT = std::nullopt;
  const auto free = evaluate_design(request);
  ASSERT_TRUE(free) << free.error().text();
  EXPECT_FALSE(free->gauge.scale_known);
  request.field_known = true;
  const auto known = evaluate_design(request);
  EXPECT_TRUE(known->gauge.scale_known);
}

TEST(Plan, WhatAnEffectNeedsMustBeInTheList) {
  const Simulation sim;
  DesignRequest request = request_of(simulate(sim, 36, 60, 5), sim);
  for (Pose& pose : request.poses.poses) pose.roll_rad = std::nullopt;
  request.effects = {*effects::library::make_effect("site.gradient")};
  EXPECT_FALSE(evaluate_design(request));
}

/// One sensor sees no gradient: what counts is its field.
TEST(Plan, ForetellsTheFieldOfOneSensor) {
  const testing::Places one = testing::one_sensor();
  const PoseTable table = testing::turned_run(one, 3);
  const fit::FitReport fitted = testing::fitted(table, one);
  DesignRequest request;
  request.poses = table;
  request.sensors = fitted.calibration.sensors;
  request.geometry = testing::geometry_of(one);
  request.f_nT = fitted.site.f_nT;
  request.inclination_rad = fitted.site.inclination_rad;
  request.declination_rad = fitted.site.declination_rad;
  request.pose_noise_nT = fitted.noise_nT;
  request.scalar_sd_nT = 0.01;
  const auto foretold = evaluate_design(request);
  ASSERT_TRUE(foretold) << foretold.error().text();
  ASSERT_TRUE(foretold->field_sd_nT.has_value());
  EXPECT_FALSE(foretold->sees_gradient());
  const double stated = fit::joint::calibration_field_sd_nT(fitted.calibration.sensors,
                                                            fitted.calibration.covariance, fitted.site.f_nT);
  EXPECT_NEAR(*foretold->field_sd_nT / stated, 1, 0.25);  // the fit estimates noise and table from the data
  ASSERT_FALSE(foretold->helpful.empty());
  for (const auto& helpful : foretold->helpful) {
    EXPECT_GT(helpful.share, 0);
    EXPECT_LT(helpful.share, 0.2);
  }
  const std::string text = report::to_text(*foretold);
  EXPECT_THAT(text, ::testing::HasSubstr("standard error of the field, nT"));
  EXPECT_THAT(text, ::testing::HasSubstr("off the field's variance"));
  EXPECT_THAT(text, ::testing::Not(::testing::HasSubstr("nan")));
}

/// By hand: an offset shifts its component whatever the attitude; a scale factor shifts it by F dc in two of
/// six directions.
TEST(Plan, TheFieldIsAsUncertainAsItsParameters) {
  const PerSensor<sensor::SensorModel> nominal(1);
  Eigen::MatrixXd offsets = Eigen::MatrixXd::Zero(12, 12), scales = offsets;
  for (const int p : {sensor::ix, sensor::iy, sensor::iz}) offsets(p, p) = 4;
  for (const int p : {sensor::cx, sensor::cy, sensor::cz}) scales(p, p) = 1e-12;
  EXPECT_NEAR(fit::joint::calibration_field_sd_nT(nominal, offsets, 50'000), 2, 1e-9);
  EXPECT_NEAR(fit::joint::calibration_field_sd_nT(nominal, scales, 50'000), 0.05 / std::sqrt(3.0), 1e-9);
}

}  // namespace
}  // namespace mgtd::calib::design
