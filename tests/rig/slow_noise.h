// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <random>
#include <vector>

/// This is the slow part of the noise of one axis, nT: processes in time that are drawn exactly at any
/// instants and, for the mean of a dwell, from their joint distribution with where the dwell leaves them.
namespace mgtd::rig {

/// One of them.
///
///     wandering  Ornstein-Uhlenbeck: stationary, standard deviation s, correlation exp(-|dt|/tau)
///     walk       independent increments: standard deviation q sqrt(dt); zero when it begins
class SlowProcess {
 public:
  [[nodiscard]] static SlowProcess wandering(double sd_nT, double tau_s) { return {sd_nT, tau_s, 0}; }
  [[nodiscard]] static SlowProcess walk(double nT_per_sqrt_h);

  [[nodiscard]] double value_nT() const { return value_nT_; }
  /// Where it is when it is first looked at.
  void begin(std::mt19937_64& random, std::normal_distribution<double>& normal);
  /// Goes on by dt.
  void advance(double dt_s, std::mt19937_64& random, std::normal_distribution<double>& normal);
  /// Mean over a length that begins now; it is left where the length ends.
  [[nodiscard]] double mean_over(double length_s, std::mt19937_64& random,
                                 std::normal_distribution<double>& normal);
  /// Expected variance of its samples in such a length about their mean, nT^2.
  [[nodiscard]] double variance_within(double length_s) const;

 private:
  SlowProcess(double sd_nT, double tau_s, double nT_per_sqrt_s)
      : sd_nT_(sd_nT), tau_s_(tau_s), nT_per_sqrt_s_(nT_per_sqrt_s) {}
  [[nodiscard]] bool walks() const { return nT_per_sqrt_s_ > 0; }

  double sd_nT_, tau_s_, nT_per_sqrt_s_;
  double value_nT_{0};
};

/// Noise of power spectral density a^2/f, `a` in nT/sqrt(Hz) at 1 Hz (one-sided): two wandering processes a
/// decade, correlation times from 0.01 to 100 000 s, each of variance a^2 ln(sqrt 10). Their sum is within 3
/// % of the law between 30 uHz and 1 Hz and falls faster above 16 Hz.
[[nodiscard]] std::vector<SlowProcess> flicker(double nT_per_sqrt_hz);

}  // namespace mgtd::rig
