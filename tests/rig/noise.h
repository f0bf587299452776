// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "tests/rig/effect.h"
#include "tests/rig/slow_noise.h"

/// This is the noise by which the readings of one fluxgate scatter.
namespace mgtd::rig {

enum class NoiseKind { gaussian, uniform, student };

/// Of one sample.
struct SampleNoise {
  NoiseKind kind{NoiseKind::gaussian};
  double noise_nT{0.3};              ///< sd; half width when uniform
  double student_dof{3};             ///< more than 2; scaled to the sd
  double ar1_rho{0};                 ///< correlation of neighbouring samples, the sd stays
  double slow_nT{0};                 ///< sd of a part that wanders with ...
  double slow_tau_s{60};             ///< ... this correlation time
  double walk_nT_per_sqrt_h{0};      ///< a random walk of each axis
  double flicker_nT_per_sqrt_hz{0};  ///< 1/f noise of each axis: amplitude spectral density at 1 Hz
  double spike_share{0};             ///< so many samples ...
  double spike_nT{0};                ///< ... are off by plus or minus this
  double lsb_nT{0};                  ///< samples are multiples of it
  double mean_step_nT{0};            ///< means of a dwell are written down in multiples of it
  bool tells_n_eff{true};            ///< of correlated samples
};

/// Of one visit to a pose: what coming back does not reproduce. Drawn anew whenever the table has moved.
struct VisitNoise {
  NoiseKind kind{NoiseKind::gaussian};
  double noise_nT{0};
  double student_dof{3};
  double rho{0};            ///< correlation from one visit to the next, the sd stays
  double outlier_share{0};  ///< so many readings of an axis at a visit ...
  double outlier_nT{0};     ///< ... are off by plus or minus this
  double cycle_nT{0};       ///< amplitude of what comes back every ...
  double cycle_visits{7};   ///< ... so many visits, ...
  Where cycle_where{};      ///< ... here
};

/// A stream per sensor, so that how often one is read does not change the others.
class SensorNoise {
 public:
  SensorNoise(const SampleNoise& sample, const VisitNoise& visit, std::uint64_t seed, std::uint32_t sensor);

  /// The table has moved.
  void visit() { visit_due_ = true; }
  /// Noisy reading of what is truly there at time t; times do not go back.
  [[nodiscard]] Eigen::Vector3d sample(const Eigen::Vector3d& true_nT, double t_s);

  struct Dwell {
    Eigen::Vector3d mean_nT{0, 0, 0}, sd_nT{0, 0, 0};
  };
  /// Mean and sample sd of n such readings at equal times, when the true one stays. Drawn from their exact
  /// distribution where that is known (Gaussian samples, with or without slow parts), else sample by sample.
  [[nodiscard]] Dwell dwell(const Eigen::Vector3d& true_nT, double from_s, int n, double period_s);

 private:
  [[nodiscard]] double draw(NoiseKind kind, double dof);
  void draw_visit();
  void wander_to(double t_s);
  [[nodiscard]] double slow_nT(std::size_t axis) const;
  [[nodiscard]] double one(std::size_t axis);
  [[nodiscard]] Dwell drawn(const Eigen::Vector3d& true_nT, double from_s, int n, double period_s);

  SampleNoise noise_;
  VisitNoise visit_noise_;
  std::mt19937_64 random_, visit_random_;
  std::normal_distribution<double> normal_;
  int sensor_;
  bool visit_due_{true}, begun_{false}, wandering_{false};
  double t_s_{0};
  int visits_{0};
  std::array<std::vector<SlowProcess>, 3> slow_;
  std::array<double, 3> previous_{}, between_visits_{}, offset_{};
};

/// Neighbouring seeds give unrelated streams.
[[nodiscard]] std::mt19937_64 noise_stream(std::uint64_t seed, std::uint32_t which);

}  // namespace mgtd::rig
