// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/readings_by_angles.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "tests/unit/calib/effects/effect_scene.h"

namespace mgtd::calib::effects::laws {
namespace {

constexpr int kPoses = 157;

struct Turned {
  PoseTable table;                         ///< what was recorded
  std::vector<Eigen::Vector3d> deviation;  ///< how far the table truly stood off its angles, rad
};

/// The rig of the paper's table 6, without noise, on a table that is off its angles by `sd_rad`.
Turned turned(double sd_rad, std::uint64_t seed) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> normal;
  const testing::Scene scene;
  const auto rig = testing::table6_rig();
  Turned out;
  for (int k = 0; k < kPoses; ++k) {
    const TableAngles recorded = testing::angles_of(scene, k, rng);
    const Eigen::Vector3d off = sd_rad * Eigen::Vector3d::NullaryExpr([&] { return normal(rng); });
    const Eigen::Vector3d b = testing::attitude(deviating(recorded, off)) * scene.f_nT * scene.direction;
    Pose pose;
    pose.number = k + 1;
    pose.azimuth_rad = recorded.azimuth_rad, pose.pitch_rad = recorded.pitch_rad,
    pose.roll_rad = recorded.roll_rad;
    for (std::size_t i = 0; i < kSensors; ++i) pose.y_nT[i] = rig[i].predict(b);
    out.table.poses.push_back(pose);
    out.deviation.push_back(off);
  }
  return out;
}

/// A turn about the field moves no reading: of it the covariance says that nothing was learnt. What is left
/// of a deviation the readings tell.
TEST(ReadingsByAngles, TellsADeviationButForATurnAboutTheField) {
  const double sd_rad = to_rad(0.1);
  const Turned run = turned(sd_rad, 3);
  const auto by_angles = ReadingsByAngles::of(run.table);
  ASSERT_TRUE(by_angles);
  double unseen = 0, seen_rad2 = 0;
  for (std::size_t k = 0; k < run.table.poses.size(); ++k) {
    const AngleDeviation& told = *by_angles->deviation(k);
    const Eigen::Vector3d error_rad = run.deviation[k] - told.mean_rad;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(told.covariance);
    EXPECT_NEAR(eigen.eigenvalues()[2], 1, 1e-2);
    EXPECT_LT(eigen.eigenvalues()[1], 1e-2);
    const Eigen::Vector3d about_field = eigen.eigenvectors().col(2);
    const double along_rad = about_field.dot(error_rad);
    unseen += along_rad * along_rad / (sd_rad * sd_rad * kPoses);
    seen_rad2 += (error_rad - along_rad * about_field).squaredNorm() / kPoses;
  }
  EXPECT_NEAR(unseen, 1, 3 * std::sqrt(2.0 / kPoses));
  // The map itself, ten numbers for each channel, is learnt from angles that are as wrong: sqrt(10/157).
  EXPECT_LT(std::sqrt(seen_rad2), 1.5 * std::sqrt(10.0 / kPoses) * sd_rad);
}

TEST(ReadingsByAngles, ItsDerivativeIsThatOfItsReadings) {
  const auto by_angles = ReadingsByAngles::of(turned(0, 5).table);
  ASSERT_TRUE(by_angles);
  const TableAngles at{0.4, -0.7, 2.1};
  constexpr double kStep_rad = 1e-3;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d step = kStep_rad * Eigen::Vector3d::Unit(i);
    const Eigen::RowVectorXd slope =
        (by_angles->at(deviating(at, step)) - by_angles->at(deviating(at, -step))) / (2 * kStep_rad);
    EXPECT_LT((by_angles->derivative(at).row(i) - slope).norm(), 1e-5 * slope.norm());
  }
}

}  // namespace
}  // namespace mgtd::calib::effects::laws
