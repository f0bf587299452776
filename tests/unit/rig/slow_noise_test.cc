// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/slow_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/rig/noise.h"

namespace mgtd::rig {
namespace {

struct Moments {
  double var_mean{0}, var_end{0}, covariance{0};
};

constexpr int kDraws = 5000;  // 2 % one sigma of a variance
constexpr double kLength_s = 2;

/// Of the mean over the length and the value at its end; `steps` 0: drawn at once.
Moments moments(const SlowProcess& process, int steps) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  Moments out;
  for (int k = 0; k < kDraws; ++k) {
    SlowProcess p = process;
    p.begin(random, normal);
    double mean = 0;
    if (steps == 0) mean = p.mean_over(kLength_s, random, normal);
    for (int i = 0; i < steps; ++i) {
      p.advance(kLength_s / steps / 2, random, normal);
      mean += p.value_nT() / steps;
      p.advance(kLength_s / steps / 2, random, normal);
    }
    out.var_mean += mean * mean / kDraws;
    out.var_end += p.value_nT() * p.value_nT() / kDraws;
    out.covariance += mean * p.value_nT() / kDraws;
  }
  return out;
}

/// The mean of a dwell is that of a path in fifty steps: scatter of both, and how they go together.
TEST(SlowNoise, AMeanIsDrawnAsThePathGivesIt) {
  for (const SlowProcess& process : {SlowProcess::walk(60), SlowProcess::wandering(1, 0.5),
                                     SlowProcess::wandering(1, 5), SlowProcess::wandering(1, 1000)}) {
    const Moments drawn = moments(process, 0), path = moments(process, 50);
    EXPECT_NEAR(drawn.var_mean / path.var_mean, 1, 0.1);
    EXPECT_NEAR(drawn.var_end / path.var_end, 1, 0.1);
    EXPECT_NEAR(drawn.covariance / path.covariance, 1, 0.1);
  }
}

/// One nT per root hour: after a quarter of an hour half a nT, and a third of the variance in the mean.
TEST(SlowNoise, AWalkSpreadsWithTheRootOfTime) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  double end = 0, mean = 0;
  for (int k = 0; k < kDraws; ++k) {
    SlowProcess walk = SlowProcess::walk(1);
    walk.begin(random, normal);
    const double m = walk.mean_over(900, random, normal);
    mean += m * m / kDraws;
    end += walk.value_nT() * walk.value_nT() / kDraws;
  }
  EXPECT_NEAR(end, 0.25, 0.02);
  EXPECT_NEAR(mean, 0.25 / 3, 0.007);
}

/// The Allan variance of a spectrum a^2/f is 2 ln 2 a^2 whatever the averaging time.
TEST(SlowNoise, FlickerHasTheSameAllanVarianceOverTwoDecades) {
  constexpr double kA = 0.01;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (const double averaged_s : {1.0, 10.0, 100.0}) {
    double allan = 0;
    for (int k = 0; k < kDraws; ++k) {
      double difference = 0;
      for (SlowProcess part : flicker(kA)) {
        part.begin(random, normal);
        difference -= part.mean_over(averaged_s, random, normal);
        difference += part.mean_over(averaged_s, random, normal);
      }
      allan += difference * difference / (2 * kDraws);
    }
    EXPECT_NEAR(allan / (2 * std::log(2) * kA * kA), 1, 0.1) << averaged_s;  // 2 % one sigma
  }
}

/// What a dwell scatters by within itself, drawn and sample by sample.
TEST(SlowNoise, SamplesOfADwellScatterAsExpected) {
  for (const SlowProcess& process : {SlowProcess::walk(60), SlowProcess::wandering(1, 3)}) {
    std::mt19937_64 random(2);
    std::normal_distribution<double> normal;
    constexpr int kSamples = 100, kDwells = 2000;
    double within = 0;
    for (int k = 0; k < kDwells; ++k) {
      SlowProcess p = process;
      p.begin(random, normal);
      std::vector<double> x;
      for (int i = 0; i < kSamples; ++i) {
        p.advance(kLength_s / kSamples, random, normal);
        x.push_back(p.value_nT());
      }
      const double mean = std::accumulate(x.begin(), x.end(), 0.0) / kSamples;
      for (const double v : x) within += (v - mean) * (v - mean) / (kSamples * kDwells);
    }
    EXPECT_NEAR(within / process.variance_within(kLength_s), 1, 0.1);  // 3 % one sigma
  }
}

}  // namespace
}  // namespace mgtd::rig
