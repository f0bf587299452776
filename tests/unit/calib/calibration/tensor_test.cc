// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration/tensor.h"

#include <gtest/gtest.h>

#include <random>

namespace mgtd::calib::calibration {
namespace {

sensor::FieldVector linear_field(const Eigen::Vector3d& B, const Eigen::Matrix3d& G,
                                 const sensor::Geometry& geometry) {
  sensor::FieldVector b(geometry.channels());
  const auto r = geometry.positions_P_m();
  for (std::size_t i = 0; i < r.size(); ++i) b.segment<3>(3 * static_cast<Eigen::Index>(i)) = B + G * r[i];
  return b;
}

Eigen::Matrix3d source_free_gradient() {
  Eigen::Matrix3d G;
  G << 120, -35, 60, -35, -80, 15, 60, 15, -40;
  return G;
}

TEST(Tensor, ALinearFieldIsFoundExactlyAndCloses) {
  const sensor::Geometry geometry;
  const Eigen::Vector3d B{20'000, -3'000, 45'000};
  const auto got = field_and_gradient(linear_field(B, source_free_gradient(), geometry), 0.4);
  constexpr double kRounding = 1e-10 / 0.4 * 5;  // one bit of 50 000 nT over the baseline
  EXPECT_LT((got.b_P_nT - B).norm(), kRounding);
  EXPECT_NEAR(got.g_nT_per_m.xx, 120, kRounding);
  EXPECT_NEAR(got.g_nT_per_m.yy, -80, kRounding);
  EXPECT_NEAR(got.g_nT_per_m.zz, -40, kRounding);
  EXPECT_NEAR(got.g_nT_per_m.xy, -35, kRounding);
  EXPECT_NEAR(got.g_nT_per_m.xz, 60, kRounding);
  EXPECT_NEAR(got.g_nT_per_m.yz, 15, kRounding);
  EXPECT_NEAR(got.closure.curl_nT_per_m, 0, kRounding);
  EXPECT_LT(got.closure.center_nT.norm(), kRounding);
}

TEST(Tensor, ACurlOrAnOddSensorDoesNotClose) {
  const sensor::Geometry geometry;
  Eigen::Matrix3d G = source_free_gradient();
  G(0, 1) += 10;  // no longer a gradient
  EXPECT_NEAR(field_and_gradient(linear_field({1, 2, 3}, G, geometry), 0.4).closure.curl_nT_per_m, 10, 1e-10);
  sensor::FieldVector b = linear_field({1, 2, 3}, source_free_gradient(), geometry);
  b[4] += 8;  // sensor 2, y
  EXPECT_NEAR(field_and_gradient(b, 0.4).closure.center_nT[1], -4, 1e-10);
}

TEST(Tensor, RowsSayTheSameAsTheArithmetic) {
  const sensor::Geometry geometry(0.5);
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0, 100);
  sensor::FieldVector b(geometry.channels());
  for (double& value : b) value = normal(random);
  const auto got = field_and_gradient(b, 0.5);
  const Eigen::Matrix<double, 6, 1> g = gradient_rows(geometry) * b;
  const Eigen::Matrix<double, 4, 1> c = closure_rows(geometry) * b;
  const Gradient& e = got.g_nT_per_m;
  EXPECT_LT((g - Eigen::Matrix<double, 6, 1>{e.xx, e.yy, e.zz, e.xy, e.xz, e.yz}).norm(), 1e-10);
  EXPECT_NEAR(c[0], got.closure.curl_nT_per_m, 1e-10);
  EXPECT_LT((c.tail<3>() - got.closure.center_nT).norm(), 1e-10);
}

Epoch epoch_of(const Calibration& c, const Eigen::Vector3d& b_P_nT) {
  Epoch epoch;
  for (std::size_t i = 0; i < kSensors; ++i) epoch.y_nT[i] = c.sensors[i].predict(b_P_nT);
  return epoch;
}

Calibration some_calibration() {
  Calibration c;
  for (int i = 0; i < kSensors; ++i) {
    const double s = 0.01 * (i + 1);
    sensor::ParameterVector p;
    p << s, -2 * s, 1.5 * s, 1 + s, 1 - s, 1 + 2 * s, 100 * s, -5000 * s, 300, -s, 2 * s, 3 * s;
    c.sensors[static_cast<std::size_t>(i)] = sensor::SensorModel::from_parameters(p);
  }
  c.sample_noise_nT.setConstant(0.3);
  c.id = "ctest";
  return c;
}

TEST(TensorPipeline, AUniformFieldGivesNoGradientAndItsCalibrationIsNamed) {
  const auto c = std::make_shared<Calibration>(some_calibration());
  const Eigen::Vector3d b{18'000, 4'000, 46'000};
  const TensorSample sample = TensorPipeline(c).apply(epoch_of(*c, b));
  EXPECT_LT((sample.b_P_nT - b).norm(), 1e-9);
  EXPECT_NEAR(sample.g_nT_per_m.xy, 0, 1e-9);
  EXPECT_EQ(*sample.calibration_id, "ctest");
  EXPECT_FALSE(sample.flags.has(Flag::uncalibrated));
  EXPECT_LT(sample.closure.chi2, 1e-9);
}

TEST(TensorPipeline, WithoutACalibrationTheSampleSaysSo) {
  const TensorSample sample = TensorPipeline(sensor::Geometry{}).apply(Epoch{});
  EXPECT_TRUE(sample.flags.has(Flag::uncalibrated));
  EXPECT_EQ(sample.calibration_id, nullptr);
  EXPECT_TRUE(std::isnan(sample.g_sd_nT_per_m.xx));
}

/// The stated standard deviations against those of many samples with noise and many calibrations with errors.
TEST(TensorPipeline, StandardDeviationsAreThoseOfManySamples) {
  Calibration truth = some_calibration();
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  Eigen::Matrix<double, kArrayParameters, 1> sd;
  for (int i = 0; i < kSensors; ++i) {
    sd.segment<sensor::kSensorParameters>(i * sensor::kSensorParameters) << 1e-5, 1e-5, 1e-5, 1e-5, 1e-5,
        1e-5, 0.3, 0.3, 0.3, 2e-5, 2e-5, 2e-5;
  }
  truth.covariance = sd.array().square().matrix().asDiagonal();
  const Eigen::Vector3d b{18'000, 4'000, 46'000};
  const TensorSample stated = TensorPipeline(std::make_shared<Calibration>(truth)).apply(epoch_of(truth, b));
  constexpr int kTrials = 4000;
  double xx = 0, xy = 0, yz = 0, chi2 = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    auto wrong = std::make_shared<Calibration>(truth);
    Epoch epoch = epoch_of(truth, b);
    for (std::size_t i = 0; i < kSensors; ++i) {
      sensor::ParameterVector p = truth.sensors[i].parameters();
      for (int k = 0; k < sensor::kSensorParameters; ++k) p[k] += sd[k] * normal(random);
      wrong->sensors[i] = sensor::SensorModel::from_parameters(p);
      for (double& y : epoch.y_nT[i]) y += 0.3 * normal(random);
    }
    const TensorSample got = TensorPipeline(wrong).apply(epoch);
    xx += got.g_nT_per_m.xx * got.g_nT_per_m.xx;
    xy += got.g_nT_per_m.xy * got.g_nT_per_m.xy;
    yz += got.g_nT_per_m.yz * got.g_nT_per_m.yz;
    chi2 += got.closure.chi2;
  }
  // The rms of 4000 trials scatters by 1.1 %; five times that.
  EXPECT_NEAR(std::sqrt(xx / kTrials) / stated.g_sd_nT_per_m.xx, 1, 0.056);
  EXPECT_NEAR(std::sqrt(xy / kTrials) / stated.g_sd_nT_per_m.xy, 1, 0.056);
  EXPECT_NEAR(std::sqrt(yz / kTrials) / stated.g_sd_nT_per_m.yz, 1, 0.056);
  EXPECT_NEAR(chi2 / kTrials, 4, 0.22);  // sd of chi-square(4) is 2.83
}

TEST(Tensor, WhatTheModelLeavesOutDoesNotAverageAway) {
  auto calibration = std::make_shared<Calibration>();
  calibration->geometry = sensor::Geometry(0.4);
  calibration->sample_noise_nT.setConstant(0.3);
  const auto sd_of = [&](double pose_noise_nT, double samples) {
    calibration->pose_noise_nT.setConstant(pose_noise_nT);
    Pose pose;
    pose.y_nT.fill({20'000, 3'000, 43'000});
    return TensorPipeline(std::make_shared<const Calibration>(*calibration))
        .apply(pose, samples)
        .g_sd_nT_per_m.xx;
  };
  // One sample scatters more than the model is wrong; a long mean does not.
  EXPECT_DOUBLE_EQ(sd_of(0.02, 1), sd_of(0, 1));
  EXPECT_NEAR(sd_of(0, 900) / sd_of(0, 1), 1.0 / 30, 1e-9);
  EXPECT_NEAR(sd_of(0.02, 900) / sd_of(0, 1), 0.02 / 0.3, 1e-9);
  EXPECT_NEAR(sd_of(5, 1) / sd_of(0, 1), 5 / 0.3, 1e-9);
}

}  // namespace
}  // namespace mgtd::calib::calibration
