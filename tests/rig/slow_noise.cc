// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/slow_noise.h"

#include <algorithm>
#include <cmath>

namespace mgtd::rig {
namespace {

using Normal = std::normal_distribution<double>;

/// Mean over the length, and where it ends: variances and covariance about the value at the beginning.
struct Joint {
  double var_end, var_mean, covariance;
};

Joint of_walk(double q, double length_s) {
  const double v = q * q * length_s;
  return {v, v / 3, v / 2};
}

Joint of_wandering(double s, double L) {
  const double e = std::exp(-L), s2 = s * s;
  // The difference cancels below L = 0.01; there the process is a walk.
  const double mean = L < 0.01 ? 2 * L / 3 * (1 - 0.75 * L) : (2 * L - 3 + 4 * e - e * e) / (L * L);
  return {-s2 * std::expm1(-2 * L), s2 * mean, s2 * std::expm1(-L) * std::expm1(-L) / L};
}

}  // namespace

SlowProcess SlowProcess::walk(double nT_per_sqrt_h) { return {0, 0, nT_per_sqrt_h / 60}; }

void SlowProcess::begin(std::mt19937_64& random, Normal& normal) {
  value_nT_ = walks() ? 0 : sd_nT_ * normal(random);
}

void SlowProcess::advance(double dt_s, std::mt19937_64& random, Normal& normal) {
  if (walks()) {
    value_nT_ += nT_per_sqrt_s_ * std::sqrt(dt_s) * normal(random);
    return;
  }
  const double decay = std::exp(-dt_s / tau_s_);
  value_nT_ = decay * value_nT_ + sd_nT_ * std::sqrt(-std::expm1(-2 * dt_s / tau_s_)) * normal(random);
}

double SlowProcess::mean_over(double length_s, std::mt19937_64& random, Normal& normal) {
  const double L = walks() ? 0 : length_s / tau_s_;
  const Joint j = walks() ? of_walk(nT_per_sqrt_s_, length_s) : of_wandering(sd_nT_, L);
  const double stays = walks() ? 1 : -std::expm1(-L) / L;
  const double u = normal(random), v = normal(random);
  const double mean = value_nT_ * stays + j.covariance / std::sqrt(j.var_end) * u +
                      std::sqrt(std::max(0.0, j.var_mean - j.covariance * j.covariance / j.var_end)) * v;
  value_nT_ = (walks() ? 1 : std::exp(-L)) * value_nT_ + std::sqrt(j.var_end) * u;
  return mean;
}

double SlowProcess::variance_within(double length_s) const {
  if (walks()) return nT_per_sqrt_s_ * nT_per_sqrt_s_ * length_s / 6;
  const double L = length_s / tau_s_;
  return sd_nT_ * sd_nT_ * (L < 0.01 ? L / 3 * (1 - L / 4) : 1 - 2 * (L + std::expm1(-L)) / (L * L));
}

std::vector<SlowProcess> flicker(double nT_per_sqrt_hz) {
  constexpr int kDecades = 7, kPerDecade = 2;
  constexpr double kFastest_s = 0.01;
  std::vector<SlowProcess> out;
  const double sd_nT = nT_per_sqrt_hz * std::sqrt(std::log(10.0) / kPerDecade);
  for (int k = 0; k <= kDecades * kPerDecade; ++k)
    out.push_back(SlowProcess::wandering(sd_nT, kFastest_s * std::pow(10.0, k / double{kPerDecade})));
  return out;
}

}  // namespace mgtd::rig
