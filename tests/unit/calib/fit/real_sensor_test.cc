// SPDX-License-Identifier: Apache-2.0
// Step 1 on a real sensor in a field of constant magnitude: tests/data/constant_norm_static.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "calib/sensor/step1.h"
#include "proto/number.h"
#include "tests/support/checkout.h"

namespace mgtd::calib::fit {
namespace {

/// Counts, one column a window of two seconds, in their order.
Eigen::Matrix3Xd static_means() {
  std::ifstream in(mgtd::testing::source_path("tests/data/constant_norm_static/static_means.csv"));
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

/// The constant magnitude in counts.
constexpr double kRadius = 4070;

double residual_rms(const sensor::ScalarCalibration& sensor, const Eigen::Matrix3Xd& y) {
  const Eigen::ArrayXd left = sensor.correct(y).colwise().norm().transpose().array() - kRadius;
  return std::sqrt(left.square().mean());
}

TEST(RealSensor, AnOffsetFarOutsideTheSphereIsFound) {
  const Eigen::Matrix3Xd y = static_means();
  ASSERT_EQ(y.cols(), 137);
  const auto fit = sensor::scalar_calibration(y, Eigen::VectorXd::Constant(y.cols(), kRadius));
  ASSERT_TRUE(fit) << fit.error().text();
  // 1.557e-4 is the least that nine parameters can leave on these data (7.8 nT on a sphere of 50 000 nT): the
  // linear fit loses nothing to the maximum of the likelihood.
  EXPECT_NEAR(residual_rms(*fit, y) / kRadius, 1.557e-4, 0.003e-4);
  EXPECT_GT(fit->offset_nT.norm(), 10 * kRadius);
}

/// What the nine parameters leave is not noise: neighbours in time resemble each other (correlation 0.28),
/// and an offset that drifts by a count over the recording, three coefficients more, takes a sixth of the
/// variance away (F = 8.2 with 3 and 125 degrees of freedom, one in 20 000 by chance). Squares and cubes of
/// the readings take nothing (F below 0.3).
TEST(RealSensor, ItsOffsetDrifts) {
  Eigen::Matrix3Xd y = static_means();
  // Counts from the first to the last window, least squares.
  const Eigen::Vector3d drift{0.557, -1.100, 0.946};
  for (Eigen::Index k = 0; k < y.cols(); ++k)
    y.col(k) -= drift * (static_cast<double>(k) / static_cast<double>(y.cols()) - 0.5);
  const auto fit = sensor::scalar_calibration(y, Eigen::VectorXd::Constant(y.cols(), kRadius));
  ASSERT_TRUE(fit) << fit.error().text();
  EXPECT_NEAR(residual_rms(*fit, y) / kRadius, 1.424e-4, 0.003e-4);
}

}  // namespace
}  // namespace mgtd::calib::fit
