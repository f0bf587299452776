// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/quantisation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/blind/hidden_run.h"

namespace mgtd::calib::fit {
namespace {

/// A run whose dwells show no spread in every second pose.
PoseTable rounded(double step_nT) {
  PoseTable table = testing::hidden_run({.noise_nT = 0.01}, 3);
  for (std::size_t k = 0; k < table.poses.size(); ++k) {
    Pose& pose = table.poses[k];
    pose.n = 100;
    if (k % 2 == 0) continue;
    for (std::size_t i = 0; i < kSensors; ++i) {
      for (std::size_t a = 0; a < 3; ++a) {
        double& y = pose.y_nT[i][static_cast<Eigen::Index>(a)];
        y = step_nT * std::round(y / step_nT);
        pose.sd_nT[i][a] = 0;
      }
    }
  }
  return table;
}

TEST(Quantisation, TheStepIsReadOffTheGrid) {
  for (const double step_nT : {0.1, 1.0, 0.2983}) {
    const Quantisation q = quantisation_of(rounded(step_nT));
    ASSERT_TRUE(q.seen());
    EXPECT_NEAR(q.step_nT, step_nT, 1e-4 * step_nT);
    EXPECT_NEAR(q.variance_nT2(2, 1), step_nT * step_nT / 12 * 78 / 157, 1e-3 * step_nT * step_nT);
  }
}

/// The samples spread by 0.3 nT, 200 of them a dwell, and their means are rounded.
PoseTable with_rounded_means(double step_nT) {
  PoseTable table = testing::hidden_run({.noise_nT = 0.01}, 3);
  for (Pose& pose : table.poses) {
    pose.n = 200;
    for (auto& sensor : pose.sd_nT) sensor.fill(0.3);
    for (Eigen::Vector3d& y_nT : pose.y_nT) y_nT = step_nT * (y_nT / step_nT).array().round();
  }
  return table;
}

TEST(Quantisation, MeansThatWereRoundedShowTheirStep) {
  for (const double step_nT : {0.1, 1.0}) {
    const Quantisation q = quantisation_of(with_rounded_means(step_nT));
    EXPECT_NEAR(q.step_nT, step_nT, 1e-9);
    EXPECT_NEAR(q.variance_nT2(2, 1), step_nT * step_nT / 12, 1e-9);
  }
}

/// Digits enough: a table with five of them has a grid that nobody needs to know.
TEST(Quantisation, AGridFarBelowTheNoiseOfAMeanShowsNone) {
  EXPECT_FALSE(quantisation_of(with_rounded_means(0.01)).seen());
}

TEST(Quantisation, ReadingsThatSpreadWithinTheirDwellsShowNone) {
  EXPECT_FALSE(quantisation_of(testing::hidden_run({.noise_nT = 0.01}, 3)).seen());
}

/// A sensor at the rail repeats one number, and that is no grid.
TEST(Quantisation, SaturatedReadingsShowNone) {
  PoseTable table = testing::hidden_run({.noise_nT = 0.01}, 3);
  for (std::size_t k = 60; k < 80; ++k) {
    Pose& pose = table.poses[k];
    pose.n = 100;
    for (std::size_t a = 0; a < 3; ++a) {
      pose.y_nT[0][static_cast<Eigen::Index>(a)] = a == 1 ? -100'000 : 100'000;
      pose.sd_nT[0][a] = 0;
    }
  }
  EXPECT_FALSE(quantisation_of(table).seen());
}

TEST(Quantisation, ReadingsWithoutSpreadOnNoGridShowNone) {
  PoseTable table = testing::hidden_run({.noise_nT = 0.01}, 3);
  for (Pose& pose : table.poses) {
    pose.n = 100;
    for (auto& sensor : pose.sd_nT) sensor.fill(0.0);
  }
  EXPECT_FALSE(quantisation_of(table).seen());
}

}  // namespace
}  // namespace mgtd::calib::fit
