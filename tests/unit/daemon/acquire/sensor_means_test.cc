// SPDX-License-Identifier: Apache-2.0
#include "daemon/acquire/sensor_means.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/support/counted_malloc.h"

namespace mgtd::daemon::acquire {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
const TableAngles kStanding{0.5, 0.25, 0};

Epoch epoch(std::uint64_t seq, const PerSensor<Eigen::Vector3d>& y_nT) {
  Epoch out;
  out.seq = seq;
  out.t.wall.ns = static_cast<std::int64_t>(seq) * 20'000'000;
  out.y_nT = y_nT;
  out.T_degC = PerSensor<double>(y_nT.size(), kNone);
  return out;
}

std::shared_ptr<const std::string> id(const char* text) { return std::make_shared<const std::string>(text); }

TEST(SensorMeans, AreThoseOfTheEpochsSinceTheLastTime) {
  SensorMeans means;
  EXPECT_FALSE(means.take());
  Epoch last = epoch(11, {{3, 4, 9}, {1, 1, 1}});
  last.T_degC = {20.5, kNone};
  means.add(epoch(10, {{1, 2, 3}, {1, 1, 1}}), nullptr, {}, std::nullopt);
  means.add(last, nullptr, {}, std::nullopt);
  const auto report = means.take();
  ASSERT_TRUE(report);
  EXPECT_EQ(report->from_seq, 10U);
  EXPECT_EQ(report->to_seq, 11U);
  EXPECT_EQ(report->t.ns, 220'000'000);
  ASSERT_EQ(report->sensors.size(), 2U);
  EXPECT_EQ(report->sensors[0].epochs, 2U);
  EXPECT_EQ(report->sensors[0].y_nT, Eigen::Vector3d(2, 3, 6));
  EXPECT_TRUE(report->sensors[0].sd_nT.isApprox(Eigen::Vector3d(std::sqrt(2), std::sqrt(2), std::sqrt(18))));
  EXPECT_EQ(report->sensors[1].sd_nT, Eigen::Vector3d::Zero());
  EXPECT_EQ(report->sensors[0].T_degC, 20.5);
  EXPECT_TRUE(std::isnan(report->sensors[1].T_degC));
  EXPECT_FALSE(means.take()) << "they were taken";

  means.add(epoch(12, {{7, 7, 7}, {8, 8, 8}}), nullptr, {}, std::nullopt);
  const auto next = means.take();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->from_seq, 12U);
  EXPECT_EQ(next->sensors[1].y_nT, Eigen::Vector3d(8, 8, 8));
  EXPECT_TRUE(next->sensors[1].sd_nT.array().isNaN().all()) << "one epoch has no spread";
}

/// The square of 50 000 nT leaves no digit for a noise of 1 pT.
TEST(SensorMeans, ASmallNoiseInTheFieldOfTheEarthIsNotLost) {
  std::mt19937_64 random(17);
  std::normal_distribution<double> noise_nT(0, 1e-3);
  SensorMeans means;
  std::vector<double> values;
  for (std::uint64_t k = 0; k < 500; ++k) {
    values.push_back(noise_nT(random));
    means.add(epoch(k, {{50'000 + values.back(), 0, -50'000 - values.back()}}), nullptr, {}, std::nullopt);
  }
  double sum = 0, squares = 0;
  for (const double v : values) sum += v;
  const double mean = sum / 500;
  for (const double v : values) squares += (v - mean) * (v - mean);
  const double sd_nT = std::sqrt(squares / 499);
  const auto report = means.take();
  ASSERT_TRUE(report);
  EXPECT_NEAR(report->sensors[0].sd_nT.x(), sd_nT, 1e-6 * sd_nT);
  EXPECT_NEAR(report->sensors[0].sd_nT.z(), sd_nT, 1e-6 * sd_nT);
  EXPECT_NEAR(report->sensors[0].y_nT.x(), 50'000 + mean, 1e-9);
}

TEST(SensorMeans, TheFieldIsThatOfOneCalibration) {
  const auto monday = id("c1"), tuesday = id("c2");
  calib::sensor::FieldVector fields_P_nT(3);
  const auto taken = [&](const std::vector<std::shared_ptr<const std::string>>& calibrations) {
    SensorMeans means;
    double field_nT = 1;
    for (const auto& calibration : calibrations) {
      fields_P_nT << field_nT, 0, 2 * field_nT;
      means.add(epoch(1, {{9, 9, 9}}), calibration, fields_P_nT, std::nullopt);
      field_nT += 2;
    }
    return *means.take();
  };
  const SensorsReport calibrated = taken({monday, monday});
  EXPECT_EQ(calibrated.calibration, "c1");
  EXPECT_EQ(calibrated.sensors[0].b_P_nT, Eigen::Vector3d(2, 0, 4));
  const SensorsReport changed = taken({monday, tuesday});
  EXPECT_EQ(changed.calibration, "c2");
  EXPECT_FALSE(changed.sensors[0].b_P_nT.allFinite()) << "a mean of two calibrations is none";
  EXPECT_FALSE(taken({nullptr, monday}).sensors[0].b_P_nT.allFinite());
  EXPECT_FALSE(taken({monday, nullptr, monday}).sensors[0].b_P_nT.allFinite());
  EXPECT_EQ(taken({monday, nullptr}).calibration, std::nullopt);
}

TEST(SensorMeans, ATableThatMovedMeanwhileStandsNowhere) {
  const auto table = [](const std::vector<std::optional<TableAngles>>& angles) {
    SensorMeans means;
    for (const auto& a : angles) means.add(epoch(1, {{1, 1, 1}}), nullptr, {}, a);
    return means.take()->table;
  };
  EXPECT_EQ(table({kStanding, kStanding}), kStanding);
  EXPECT_FALSE(table({kStanding, std::nullopt}));
  EXPECT_FALSE(table({std::nullopt, kStanding}));
}

TEST(SensorMeans, AReadingThatIsNoNumberCountsForNothing) {
  SensorMeans means;
  means.add(epoch(1, {{kNone, 1, 1}, {2, 2, 2}}), nullptr, {}, std::nullopt);
  means.add(epoch(2, {{5, 5, 5}, {4, 4, 4}}), nullptr, {}, std::nullopt);
  const auto report = means.take();
  ASSERT_TRUE(report);
  EXPECT_EQ(report->sensors[0].epochs, 1U);
  EXPECT_EQ(report->sensors[0].y_nT, Eigen::Vector3d(5, 5, 5));
  EXPECT_EQ(report->sensors[1].epochs, 2U);
}

TEST(SensorMeans, AddingAllocatesNothing) {
  if (!MGTD_COUNTS_ALLOCATIONS) GTEST_SKIP() << "this build has a malloc of its own";
  const auto calibration = id("c1");
  const PerSensor<Eigen::Vector3d> y_nT(kMostSensors, {20'000, 3'000, 45'000});
  const Epoch one = epoch(1, y_nT);
  const calib::sensor::FieldVector fields_P_nT =
      calib::sensor::FieldVector::Ones(calib::sensor::kMostChannels);
  SensorMeans means;
  const std::size_t before = testing::allocations;
  for (int k = 0; k < 100; ++k) means.add(one, calibration, fields_P_nT, kStanding);
  EXPECT_EQ(testing::allocations, before);
  EXPECT_TRUE(means.take());
  EXPECT_TRUE(id("c2"));
  EXPECT_GT(testing::allocations, before) << "allocations are counted";
}

}  // namespace
}  // namespace mgtd::daemon::acquire
