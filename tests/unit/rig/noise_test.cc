// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace mgtd::rig {
namespace {

constexpr int kSamples = 20'000;

std::vector<double> samples(const SampleNoise& noise) {
  SensorNoise source(noise, {}, 1, 0);
  std::vector<double> out;
  for (int k = 0; k < kSamples; ++k) out.push_back(source.sample({0, 0, 0}, 0.02 * k)[0]);
  return out;
}

/// Mean product of numbers so many places apart, over the mean square.
double correlation(const std::vector<double>& x, std::size_t apart) {
  double product = 0, square = 0;
  for (std::size_t k = 0; k + apart < x.size(); ++k) product += x[k] * x[k + apart];
  for (const double v : x) square += v * v;
  return product / square;
}

double sd(const std::vector<double>& x) {
  double square = 0;
  for (const double v : x) square += v * v;
  return std::sqrt(square / static_cast<double>(x.size()));
}

TEST(Noise, NeighboursAreAsCorrelatedAsTold) {
  const auto x = samples({.noise_nT = 0.3, .ar1_rho = 0.8});
  EXPECT_NEAR(sd(x), 0.3, 0.01);              // 1.1 % one sigma: correlated samples count 0.22
  EXPECT_NEAR(correlation(x, 1), 0.8, 0.02);  // 0.5 %
  EXPECT_NEAR(correlation(x, 2), 0.64, 0.03);
}

TEST(Noise, HeavyTailsKeepTheirSd) {
  const auto x = samples({.kind = NoiseKind::student, .noise_nT = 1, .student_dof = 5});
  EXPECT_NEAR(sd(x), 1, 0.05);  // fourth moment 9: 1 % one sigma
  const auto far = std::count_if(x.begin(), x.end(), [](double v) { return std::abs(v) > 4; });
  EXPECT_GT(far, 20);  // a Gaussian has 1.3 of them
}

TEST(Noise, ReadingsAreMultiplesOfTheStep) {
  for (const double v : samples({.noise_nT = 1, .lsb_nT = 0.5})) EXPECT_EQ(v, 0.5 * std::round(v / 0.5));
}

TEST(Noise, AVisitKeepsItsOffsetUntilTheTableMoves) {
  SensorNoise source({.noise_nT = 0}, {.noise_nT = 1, .rho = 0.5}, 1, 0);
  std::vector<double> visits;
  for (int k = 0; k < kSamples; ++k) {
    source.visit();
    visits.push_back(source.sample({0, 0, 0}, k)[0]);
    ASSERT_EQ(source.sample({0, 0, 0}, k + 0.5)[0], visits.back());
  }
  EXPECT_NEAR(sd(visits), 1, 0.03);
  EXPECT_NEAR(correlation(visits, 1), 0.5, 0.03);
}

TEST(Noise, ACycleComesBackAfterItsVisitsOnItsAxisOnly) {
  SensorNoise source({.noise_nT = 0},
                     {.cycle_nT = 2, .cycle_visits = 7, .cycle_where = *Where::parse("s2.y")}, 1, 1);
  for (int k = 0; k < 21; ++k) {
    source.visit();
    const Eigen::Vector3d y_nT = source.sample({0, 0, 0}, k);
    EXPECT_NEAR(y_nT[1], 2 * std::cos(2 * M_PI * k / 7), 1e-12);
    EXPECT_EQ(y_nT[0], 0);
  }
}

}  // namespace
}  // namespace mgtd::rig
