// SPDX-License-Identifier: Apache-2.0
#include "calib/sensor/step1.h"

#include <gmock/gmock.h>

#include <Eigen/LU>
#include <cmath>

#include "calib/fit/orientation.h"
#include "proto/units.h"
#include "tests/support/paper_rigs.h"

namespace mgtd::calib::sensor {
namespace {

using mgtd::testing::Noise;
using ::testing::HasSubstr;

struct Data {
  Eigen::Matrix3Xd y_nT;
  Eigen::VectorXd f_nT;
};

Data data_of(const PoseTable& table, std::size_t sensor) {
  const auto n = static_cast<Eigen::Index>(table.poses.size());
  Data out{Eigen::Matrix3Xd(3, n), Eigen::VectorXd(n)};
  for (Eigen::Index k = 0; k < n; ++k) {
    out.y_nT.col(k) = table.poses[static_cast<std::size_t>(k)].y_nT.at(sensor);
    out.f_nT[k] = *table.poses[static_cast<std::size_t>(k)].f_nT;
  }
  return out;
}

PoseTable clean() {
  return mgtd::testing::measure(testing::table3_rig(), {50'000, 60, -5}, mgtd::testing::standard_run(121, 1),
                                36, {}, 1);
}

void expect_truth(const ScalarCalibration& got, const testing::SensorTruth& truth, double relative,
                  double offset_nT) {
  const SensorModel s = fit::sensor_from(got.K, got.offset_nT, Eigen::Matrix3d::Identity());
  EXPECT_NEAR(to_deg(s.theta_rad), truth[0], to_deg(relative));
  EXPECT_NEAR(to_deg(s.phi_rad), truth[1], to_deg(relative));
  EXPECT_NEAR(to_deg(s.psi_rad), truth[2], to_deg(relative));
  for (int a = 0; a < 3; ++a) {
    EXPECT_NEAR(s.scale[a], truth.at(static_cast<std::size_t>(3 + a)), relative);
    EXPECT_NEAR(s.offset_nT[a], truth.at(static_cast<std::size_t>(6 + a)), offset_nT);
  }
}

TEST(Step1, WithoutNoiseItIsExact) {
  const PoseTable table = clean();
  for (std::size_t i = 0; i < 4; ++i) {
    const Data d = data_of(table, i);
    const auto got = scalar_calibration(d.y_nT, d.f_nT);
    ASSERT_TRUE(got) << got.error().text();
    // Rounding times the square of the condition (normal equations), some tens squared.
    expect_truth(*got, testing::table3_rig().at(i), 1e-12, 1e-7);
  }
}

TEST(Step1, NinePosesInGeneralPositionAreEnough) {
  PoseTable table = clean();
  table.poses.erase(table.poses.begin(), table.poses.begin() + 36);
  table.poses.resize(9);
  const Data d = data_of(table, 0);
  const auto got = scalar_calibration(d.y_nT, d.f_nT);
  ASSERT_TRUE(got) << got.error().text();
  expect_truth(*got, testing::table3_rig()[0], 1e-9, 1e-4);
}

/// Eq. 10 as printed is solved by V = (0, ..., 0, H^2) without any residual. Here a constant field must give
/// the scale.
TEST(Step1, TheTrivialSolutionIsImpossible) {
  const Data d = data_of(clean(), 1);
  const auto got = scalar_calibration(d.y_nT, d.f_nT);
  ASSERT_TRUE(got);
  EXPECT_GT(std::abs(got->K.determinant()), 0.5);
  const Eigen::VectorXd size = got->correct(d.y_nT).colwise().norm();
  EXPECT_LT((size - d.f_nT).norm(), 1e-6);
  const Eigen::Matrix3Xd b = got->correct(d.y_nT);
  EXPECT_GT((b.colwise() - Eigen::Vector3d(b.rowwise().mean())).norm(), 100'000);
}

/// Scalar calibration does not know in which unit the readings come, nor how far off zero they are.
TEST(Step1, AnyOffsetAndAnyScaleOfTheReadingsWork) {
  const Data d = data_of(clean(), 2);
  for (const double offset : {1e3, 6e4, 1e6}) {
    for (const double scale : {1.0, 1e-5, 1e4}) {
      const Eigen::Matrix3Xd y =
          (scale * d.y_nT).colwise() + scale * Eigen::Vector3d{offset, -2 * offset, offset};
      const auto got = scalar_calibration(y, d.f_nT);
      ASSERT_TRUE(got) << offset << ' ' << scale << ' ' << got.error().text();
      const Eigen::VectorXd size = got->correct(y).colwise().norm();
      EXPECT_LT((size - d.f_nT).cwiseAbs().maxCoeff(), 1e-12 * (5e4 + offset) * 100)
          << offset << ' ' << scale;
    }
  }
}

/// The field changes by 200 nT during the run and the scalar reference follows it.
TEST(Step1, AFieldThatChangesFromPoseToPoseIsFollowed) {
  const testing::SensorTruth truth = testing::table3_rig()[3];
  Data d = data_of(clean(), 3);
  Eigen::Vector3d offset{truth[6], truth[7], truth[8]};
  for (Eigen::Index k = 0; k < d.f_nT.size(); ++k) {
    const double f = 50'000 + 200 * std::sin(0.1 * static_cast<double>(k));
    d.y_nT.col(k) = (d.y_nT.col(k) - offset) * (f / d.f_nT[k]) + offset;
    d.f_nT[k] = f;
  }
  const auto got = scalar_calibration(d.y_nT, d.f_nT);
  ASSERT_TRUE(got);
  expect_truth(*got, truth, 1e-9, 1e-4);
}

/// Many poses are summed in another order: the same poses twice must give what they give once.
TEST(Step1, ManyPosesGiveWhatFewGive) {
  const PoseTable table =
      mgtd::testing::measure(testing::table3_rig(), {50'000, 60, -5}, mgtd::testing::standard_run(1464, 1),
                             36, {Noise::Kind::gaussian, 1, 0}, 3);
  const Data once = data_of(table, 1);
  const Eigen::Index n = once.y_nT.cols();
  ASSERT_EQ(n, 1500);
  Data twice{Eigen::Matrix3Xd(3, 2 * n), Eigen::VectorXd(2 * n)};
  twice.y_nT << once.y_nT, once.y_nT;
  twice.f_nT << once.f_nT, once.f_nT;
  const auto few = scalar_calibration(once.y_nT, once.f_nT),
             many = scalar_calibration(twice.y_nT, twice.f_nT);
  ASSERT_TRUE(few && many);
  EXPECT_LT((few->K - many->K).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((few->offset_nT - many->offset_nT).cwiseAbs().maxCoeff(), 1e-7);
  EXPECT_NEAR(few->condition, many->condition, 1e-9 * few->condition);
}

TEST(Step1, ManyPosesAboutOneAxisAreRefusedToo) {
  const PoseTable table =
      mgtd::testing::measure(testing::table3_rig(), {50'000, 60, -5}, mgtd::testing::standard_run(0, 1), 36,
                             {Noise::Kind::gaussian, 1, 0.1}, 1);
  const Data level = data_of(table, 0);
  const Data many{level.y_nT.replicate(1, 60), level.f_nT.replicate(60, 1)};
  const auto got = scalar_calibration(many.y_nT, many.f_nT);
  ASSERT_FALSE(got);
  EXPECT_THAT(got.error().text(), HasSubstr("the readings lie on a plane"));
}

TEST(Step1, PosesAboutOneAxisAreRefusedWithTheSpread) {
  PoseTable table =
      mgtd::testing::measure(testing::table3_rig(), {50'000, 60, -5}, mgtd::testing::standard_run(0, 1), 36,
                             {Noise::Kind::gaussian, 1, 0.1}, 1);
  const Data d = data_of(table, 0);
  const auto got = scalar_calibration(d.y_nT, d.f_nT);
  ASSERT_FALSE(got);
  EXPECT_EQ(got.error().code, ErrorCode::refused);
  EXPECT_THAT(got.error().message, HasSubstr("plane"));
  EXPECT_THAT(got.error().remedy, HasSubstr("second and a third axis"));
}

/// Two planes of attitudes: readings fill space but nine columns stay dependent.
TEST(Step1, AttitudesOnTwoCirclesAreRefusedWithTheCondition) {
  std::vector<testing::AttitudeDeg> attitudes;
  for (int k = 0; k < 18; ++k) attitudes.push_back({20.0 * k, 0, 0});
  for (int k = 0; k < 18; ++k) attitudes.push_back({20.0 * k, 180, 0});
  const PoseTable table = mgtd::testing::measure(testing::table3_rig(), {50'000, 60, -5}, attitudes, 18,
                                                 {Noise::Kind::gaussian, 0.1, 0}, 1);
  const Data d = data_of(table, 0);
  const auto got = scalar_calibration(d.y_nT, d.f_nT);
  ASSERT_FALSE(got);
  EXPECT_THAT(got.error().message, HasSubstr("condition number"));
  EXPECT_THAT(got.error().message, HasSubstr("limit"));
}

TEST(Step1, FewerThanNinePosesAreRefused) {
  const Data d = data_of(clean(), 0);
  const auto got = scalar_calibration(d.y_nT.leftCols(8), d.f_nT.head(8));
  ASSERT_FALSE(got);
  EXPECT_THAT(got.error().message, HasSubstr("8 poses"));
}

/// One axis saturates at half the field: no ellipsoid, or one that is refused or leaves a residual.
TEST(Step1, AQuadricThatIsNoEllipsoidIsRefused) {
  Data d = data_of(clean(), 0);
  for (Eigen::Index k = 0; k < d.y_nT.cols(); ++k) {
    // Points of a hyperboloid of one sheet.
    const double u = 0.37 * static_cast<double>(k), v = std::sin(1.7 * static_cast<double>(k));
    d.y_nT.col(k) =
        5e4 * Eigen::Vector3d{std::cosh(v) * std::cos(u), std::cosh(v) * std::sin(u), std::sinh(v)};
  }
  const auto got = scalar_calibration(d.y_nT, d.f_nT);
  ASSERT_FALSE(got);
  EXPECT_THAT(got.error().message, HasSubstr("ellipsoid"));
}

TEST(Step1, TheSimplifiedMethodLeavesHundredsOfNanotesla) {
  const PoseTable table = clean();
  for (std::size_t i = 0; i < 4; ++i) {
    const Data d = data_of(table, i);
    const auto simple = simplified_calibration(d.y_nT, d.f_nT);
    ASSERT_TRUE(simple);
    const Eigen::VectorXd size = simple->correct(d.y_nT).colwise().norm();
    const double rms = std::sqrt((size - d.f_nT).squaredNorm() / static_cast<double>(d.f_nT.size()));
    EXPECT_GT(rms, 100);
    EXPECT_LT(rms, 2000);
  }
}

}  // namespace
}  // namespace mgtd::calib::sensor
