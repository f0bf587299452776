// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/method_choice/fit.h"

#include <gmock/gmock.h>

#include <cmath>

#include "calib/report/fit_reasons.h"
#include "tests/support/paper_rigs.h"
#include "tests/unit/calib/fit/fitted_arrays.h"

namespace mgtd::calib::fit {
namespace {

using mgtd::testing::Noise;
using mgtd::testing::RigTruth;
using mgtd::testing::Site;
using ::testing::HasSubstr;

FitOptions two_step_options() {
  FitOptions options;
  options.method = Method::two_step;
  return options;
}

/// Estimates in the units of the tables: deg, 1, nT.
std::array<double, 12> in_table_units(const sensor::SensorModel& s) {
  sensor::ParameterVector p = s.parameters();
  for (const int angle :
       {sensor::theta, sensor::phi, sensor::psi, sensor::alpha, sensor::beta, sensor::gamma})
    p[angle] = to_deg(p[angle]);
  std::array<double, 12> out{};
  for (int k = 0; k < sensor::kSensorParameters; ++k) out.at(static_cast<std::size_t>(k)) = p[k];
  return out;
}

/// What the true parameters leave of |b| - F on the same data, per sensor.
std::array<double, 4> floor_of(const PoseTable& table, const RigTruth& rig, double f_nT) {
  std::array<double, 4> out{};
  for (std::size_t i = 0; i < 4; ++i) {
    sensor::ParameterVector p;
    for (int k = 0; k < sensor::kSensorParameters; ++k) p[k] = rig[i].at(static_cast<std::size_t>(k));
    for (const int angle :
         {sensor::theta, sensor::phi, sensor::psi, sensor::alpha, sensor::beta, sensor::gamma})
      p[angle] = to_rad(p[angle]);
    const sensor::SensorModel truth = sensor::SensorModel::from_parameters(p);
    double sum = 0;
    for (const Pose& pose : table.poses) sum += std::pow(truth.correct(pose.y_nT.at(i)).norm() - f_nT, 2);
    out.at(i) = std::sqrt(sum / static_cast<double>(table.poses.size()));
  }
  return out;
}

TEST(TwoStepFit, ReachesTheNoiseFloorOnThePapersSimulation) {
  const Site site{50'000, 60, -5};
  const PoseTable table = mgtd::testing::measure(
      mgtd::testing::table3_rig(), site, mgtd::testing::grid_5832(), 18, {Noise::Kind::uniform, 1.0, 0.0}, 3);
  FitOptions options = two_step_options();
  options.declination_rad = to_rad(-5.0);
  const auto report = method_choice::fit(table, options);
  ASSERT_TRUE(report) << report.error().text();
  const auto floor = floor_of(table, mgtd::testing::table3_rig(), site.f_nT);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT(report->after.total_field_rmse_nT.at(i), 1.005 * floor.at(i));
    EXPECT_GT(report->simplified->total_field_rmse_nT.at(i), 100);  // the paper: 317 to 500 nT
    const auto got = in_table_units(report->calibration.sensors.at(i));
    for (std::size_t k = 0; k < 12; ++k) {
      const double limit = k >= 3 && k <= 5 ? 1e-5 : k >= 6 && k <= 8 ? 0.1 : 0.002;
      EXPECT_NEAR(got.at(k), mgtd::testing::table3_rig().at(i).at(k), limit)
          << "s" << i + 1 << ' ' << sensor::kParameterNames.at(k);
    }
  }
  EXPECT_NEAR(to_deg(report->site.inclination_rad), 60, 0.002);
}

TEST(TwoStepFit, FindsTheTableFrameFromTiltedPosesWithinItsUncertainty) {
  const RigTruth rig = mgtd::testing::table6_rig();
  const PoseTable table = mgtd::testing::measure(rig, {53'907.7, 60, -5}, mgtd::testing::standard_run(121, 5),
                                                 36, {Noise::Kind::gaussian, 0.3, 0.1}, 17);
  const auto report = method_choice::fit(table, two_step_options());
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_TRUE(report->calibration.accepted_by_checks)
      << (report::fit_reasons(*report).empty() ? "" : report::fit_reasons(*report).front());
  EXPECT_NEAR(report->site.declination_rad, to_rad(-5), 4.5 * report->site.declination_sd_rad);
  EXPECT_LT(to_deg(report->site.declination_sd_rad), 0.05);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto got = in_table_units(report->calibration.sensors.at(i));
    for (int k = 0; k < sensor::kSensorParameters; ++k) {
      const auto at = static_cast<Eigen::Index>(i) * sensor::kSensorParameters + k;
      double sd = std::sqrt(report->calibration.covariance(at, at));
      if (k <= sensor::psi || k >= sensor::alpha) sd = to_deg(sd);
      EXPECT_NEAR(got.at(static_cast<std::size_t>(k)), rig.at(i).at(static_cast<std::size_t>(k)), 4.5 * sd)
          << "s" << i + 1 << ' ' << sensor::kParameterNames.at(static_cast<std::size_t>(k));
    }
  }
  ASSERT_TRUE(report->held_out);
  ASSERT_TRUE(report->halves);
}

/// The cost before the fit is that of all sensors, however many.
TEST(TwoStepFit, TakesAnyNumberOfSensors) {
  for (const calib::testing::Places& places :
       {calib::testing::one_sensor(), calib::testing::two_along_x(), calib::testing::cube_of_eight()}) {
    const PoseTable table = calib::testing::turned_run(places, 3);
    for (const Method method : {Method::two_step, Method::simplified}) {
      FitOptions options = calib::testing::options_of(places);
      options.method = method;
      const auto report = method_choice::fit(table, options);
      ASSERT_TRUE(report) << places.size() << ": " << report.error().text();
      const calibration::Calibration& c = report->calibration;
      ASSERT_EQ(c.sensors.size(), places.size());
      const double n = static_cast<double>(c.poses);
      double cost = 0;
      for (std::size_t i = 0; i < places.size(); ++i) {
        const double variance = c.pose_noise_nT.row(static_cast<Eigen::Index>(i)).squaredNorm() / 3;
        cost += n * std::pow(report->before.total_field_rmse_nT[i], 2) / variance;
      }
      EXPECT_NEAR(report->summary.initial_cost / cost, 1, 0.2) << places.size();
    }
  }
}

/// The sensor that the others contradict is named; of two either may be wrong, and one has nobody beside it.
TEST(TwoStepFit, OfAnyNumberOfSensorsTheOneThatIsWrongIsNamed) {
  const std::vector<std::pair<calib::testing::Places, std::string>> arrays{
      {calib::testing::two_along_x(), "pose"}, {calib::testing::cube_of_eight(), "s8"}};
  for (const auto& [places, where] : arrays) {
    PoseTable table = calib::testing::turned_run(places, 3);
    for (std::size_t k = 40; k < 60; ++k) table.poses[k].y_nT.back() *= 1.3;
    FitOptions options = calib::testing::options_of(places);
    options.method = Method::two_step;
    const auto report = method_choice::fit(table, options);
    ASSERT_TRUE(report) << where << ": " << report.error().text();
    ASSERT_EQ(report->outliers.size(), 20U) << where;
    for (const OutlierNode& node : report->outliers) EXPECT_EQ(node.where, where) << node.pose;
  }
}

TEST(TwoStepFit, PosesAboutOneAxisAreRefused) {
  const PoseTable table =
      mgtd::testing::measure(mgtd::testing::table6_rig(), {50'000, 60, -5}, mgtd::testing::standard_run(0, 1),
                             36, {Noise::Kind::gaussian, 0.3, 0.1}, 1);
  const auto report = method_choice::fit(table, two_step_options());
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::refused);
  EXPECT_THAT(report.error().message, HasSubstr("lie on a plane"));
  EXPECT_THAT(report.error().remedy, HasSubstr("second"));
}

TEST(TwoStepFit, AFieldAlongZOrHorizontalIsRefusedWithTheConditionNumber) {
  for (const double inclination_deg : {89.5, -89.5, 0.3}) {
    const PoseTable table =
        mgtd::testing::measure(mgtd::testing::table6_rig(), {50'000, inclination_deg, -5},
                               mgtd::testing::standard_run(121, 1), 36, {Noise::Kind::gaussian, 0.3, 0.0}, 1);
    const auto report = method_choice::fit(table, two_step_options());
    ASSERT_FALSE(report) << inclination_deg;
    EXPECT_THAT(report.error().message, HasSubstr("condition number"));
  }
}

TEST(TwoStepFit, WithoutStandardPosesOrFieldItSaysWhatIsMissing) {
  PoseTable table =
      mgtd::testing::measure(mgtd::testing::table6_rig(), {50'000, 60, -5},
                             mgtd::testing::standard_run(121, 1), 0, {Noise::Kind::gaussian, 0.3, 0.0}, 1);
  EXPECT_THAT(method_choice::fit(table, two_step_options()).error().message, HasSubstr("standard"));
  for (Pose& pose : table.poses) pose.f_nT.reset();
  EXPECT_THAT(method_choice::fit(table, two_step_options()).error().remedy, HasSubstr("--field"));
}

TEST(TwoStepFit, FewerThanNinePosesAreRefused) {
  PoseTable table =
      mgtd::testing::measure(mgtd::testing::table6_rig(), {50'000, 60, -5},
                             mgtd::testing::standard_run(121, 1), 36, {Noise::Kind::gaussian, 0.3, 0.0}, 1);
  table.poses.resize(8);
  EXPECT_THAT(method_choice::fit(table, two_step_options()).error().message, HasSubstr("8 poses"));
}

/// A southern site: the field points up.
TEST(TwoStepFit, TheSignOfBzIsFound) {
  const PoseTable table =
      mgtd::testing::measure(mgtd::testing::table6_rig(), {50'000, -55, 20},
                             mgtd::testing::standard_run(121, 3), 36, {Noise::Kind::gaussian, 0.3, 0.05}, 2);
  const auto report = method_choice::fit(table, two_step_options());
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_NEAR(to_deg(report->site.inclination_rad), -55, 0.2);
  EXPECT_NEAR(to_deg(report->site.declination_rad), 20, 0.2);
  EXPECT_TRUE(report->calibration.sensors[0].mounting.isIdentity());
}

/// The declared inclination contradicts the turn: reversed table angles.
TEST(TwoStepFit, ReversedAzimuthIsNoticed) {
  PoseTable table =
      mgtd::testing::measure(mgtd::testing::table6_rig(), {50'000, 60, -5},
                             mgtd::testing::standard_run(121, 3), 36, {Noise::Kind::gaussian, 0.3, 0.05}, 2);
  for (Pose& pose : table.poses) pose.azimuth_rad = -*pose.azimuth_rad;
  FitOptions options = two_step_options();
  options.inclination_rad = to_rad(60.0);
  const auto report = method_choice::fit(table, options);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_FALSE(report->calibration.accepted_by_checks);
}

TEST(TwoStepFit, EveryTurnedAndMirroredSensorIsRecognised) {
  const PoseTable upright =
      mgtd::testing::measure(mgtd::testing::table6_rig(), {50'000, 60, -5},
                             mgtd::testing::standard_run(121, 4), 36, {Noise::Kind::gaussian, 0.3, 0.05}, 9);
  constexpr std::array<std::array<int, 3>, 6> kOrders{
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  for (const auto& order : kOrders) {
    for (int signs = 0; signs < 8; ++signs) {
      PoseTable table = upright;
      Eigen::Matrix3d wiring = Eigen::Matrix3d::Zero();  // new axis from old axis
      for (int a = 0; a < 3; ++a)
        wiring(a, order.at(static_cast<std::size_t>(a))) = (signs >> a & 1) != 0 ? -1 : 1;
      for (Pose& pose : table.poses) pose.y_nT[2] = wiring * pose.y_nT[2];
      const auto report = method_choice::fit(table, two_step_options());
      ASSERT_TRUE(report) << report.error().text();
      EXPECT_EQ(report->calibration.sensors[2].mounting, Eigen::Matrix3d(wiring.transpose()));
      EXPECT_LT(report->after.tensor_rmse_nT_per_m.xx, 30);
      EXPECT_EQ(report::fit_reasons(*report).empty(), wiring.isIdentity());
    }
  }
}

}  // namespace
}  // namespace mgtd::calib::fit
