// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/scalar_ml.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "calib/fit/sensor_start.h"
#include "proto/number.h"
#include "tests/unit/calib/fit/simulated_poses.h"

namespace mgtd::calib {
namespace {

Eigen::Matrix3Xd static_means() {
  std::ifstream in(MGTD_SOURCE_DIR "/tests/data/constant_norm_static/static_means.csv");
  std::string line;
  std::getline(in, line);
  std::vector<Eigen::Vector3d> rows;
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    std::string cell;
    Eigen::Vector3d row;
    for (int a = 0; a < 3 && std::getline(fields, cell, ','); ++a) row[a] = *parse_number(cell);
    rows.push_back(row);
  }
  Eigen::Matrix3Xd y(3, static_cast<Eigen::Index>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) y.col(static_cast<Eigen::Index>(k)) = rows[k];
  return y;
}

/// The constant magnitude in a unit in which this sensor reads at nominal scale.
constexpr double kRadius = 4070;

TEST(ScalarMl, RealSensorWithAnOffsetFarOutsideTheSphere) {
  const Eigen::Matrix3Xd y = static_means();
  ASSERT_EQ(y.cols(), 137);
  const Eigen::VectorXd f = Eigen::VectorXd::Constant(y.cols(), kRadius);
  const auto start = sensor_start(y, f);
  ASSERT_TRUE(start) << start.error().text();
  const auto fit = scalar_ml(y, f, *start);
  ASSERT_TRUE(fit) << fit.error().text();
  // 1.557e-4 is the least that nine parameters can leave on these data (7.8 nT on a sphere of 50 000 nT).
  EXPECT_NEAR(fit->residual_rms_nT / kRadius, 1.557e-4, 0.003e-4);
  EXPECT_GT(fit->sensor.offset_nT.norm(), 10 * kRadius);
}

/// What the nine parameters leave is not noise: neighbours in time resemble each other (correlation 0.28),
/// and an offset that drifts by a count over the recording, three coefficients more, takes a sixth of the
/// variance away (F = 8.2 with 3 and 125 degrees of freedom, one in 20 000 by chance). Squares and cubes of
/// the readings take nothing (F below 0.3).
TEST(ScalarMl, TheRealSensorsOffsetDrifts) {
  Eigen::Matrix3Xd y = static_means();
  const Eigen::VectorXd f = Eigen::VectorXd::Constant(y.cols(), kRadius);
  const Eigen::Vector3d drift{0.557, -1.100,
                              0.946};  // counts from the first to the last window, least squares
  for (Eigen::Index k = 0; k < y.cols(); ++k)
    y.col(k) -= drift * (static_cast<double>(k) / static_cast<double>(y.cols()) - 0.5);
  const auto fit = scalar_ml(y, f, *sensor_start(y, f));
  ASSERT_TRUE(fit);
  EXPECT_LT(fit->residual_rms_nT / kRadius, 1.44e-4);
  EXPECT_NEAR(fit->residual_rms_nT / kRadius, 1.424e-4, 0.003e-4);
}

TEST(ScalarMl, TheStartDoesNotDecideTheEnd) {
  const Eigen::Matrix3Xd y = static_means();
  const Eigen::VectorXd f = Eigen::VectorXd::Constant(y.cols(), kRadius);
  const auto near = scalar_ml(y, f, *sensor_start(y, f));
  ScalarCalibration far;
  far.offset_nT = y.rowwise().mean();
  const auto from_far = scalar_ml(y, f, far);
  ASSERT_TRUE(near && from_far) << (near ? from_far.error().text() : near.error().text());
  EXPECT_NEAR(from_far->residual_rms_nT, near->residual_rms_nT, 1e-6);
  EXPECT_LT((from_far->sensor.offset_nT - near->sensor.offset_nT).norm(), 0.1);
}

TEST(ScalarMl, CollapseIsRefused) {
  // Readings on a small cap: the ellipsoid and its collapse fit alike, the start decides which is near.
  std::mt19937_64 rng(3);
  std::normal_distribution<double> normal;
  Eigen::Matrix3Xd y(3, 40);
  for (Eigen::Index k = 0; k < y.cols(); ++k) {
    y.col(k) = 50'000 * Eigen::Vector3d{0.05 * normal(rng), 0.05 * normal(rng), 1}.normalized() +
               20 * Eigen::Vector3d{normal(rng), normal(rng), normal(rng)};
  }
  const Eigen::VectorXd f = Eigen::VectorXd::Constant(y.cols(), 50'000);
  ScalarCalibration collapsing;
  collapsing.K *= 1e-3;
  collapsing.offset_nT = {0, 0, -5e7};
  // In |b| the collapse fits: every reading gives 50 000 nT within two parts in a thousand.
  EXPECT_LT((collapsing.correct(y).colwise().norm().array() / 50'000 - 1).abs().maxCoeff(), 2e-3);
  EXPECT_FALSE(scalar_ml(y, f, collapsing));
}

}  // namespace
}  // namespace mgtd::calib
