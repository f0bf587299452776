// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/noise.h"

#include <cmath>

namespace mgtd::rig {

std::mt19937_64 noise_stream(std::uint64_t seed, std::uint32_t which) {
  std::seed_seq words{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U), which};
  return std::mt19937_64(words);
}

SensorNoise::SensorNoise(const SampleNoise& sample, const VisitNoise& visit, std::uint64_t seed,
                         std::uint32_t which)
    : noise_(sample),
      visit_noise_(visit),
      random_(noise_stream(seed, which)),
      visit_random_(noise_stream(seed, which + 16)) {}

/// Unit sd, except uniform: half width one.
double SensorNoise::draw(NoiseKind kind, double dof) {
  if (kind == NoiseKind::uniform) return std::uniform_real_distribution<double>(-1, 1)(random_);
  if (kind == NoiseKind::gaussian) return normal_(random_);
  return std::student_t_distribution<double>(dof)(random_) * std::sqrt((dof - 2) / dof);
}

void SensorNoise::draw_visit() {
  visit_due_ = false;
  const VisitNoise& v = visit_noise_;
  if (v.noise_nT == 0 && v.outlier_share == 0) return;
  std::swap(random_, visit_random_);  // visits have a stream of their own
  for (std::size_t a = 0; a < 3; ++a) {
    const double fresh = draw(v.kind, v.student_dof);
    between_visits_.at(a) =
        begun_ ? v.rho * between_visits_.at(a) + std::sqrt(1 - v.rho * v.rho) * fresh : fresh;
    offset_.at(a) = v.noise_nT * between_visits_.at(a);
    std::uniform_real_distribution<double> unit(0, 1);
    const double luck = unit(random_);
    if (luck < v.outlier_share) offset_.at(a) += luck < v.outlier_share / 2 ? -v.outlier_nT : v.outlier_nT;
  }
  normal_.reset();
  std::swap(random_, visit_random_);
  begun_ = true;
}

/// The slow part, an Ornstein-Uhlenbeck process, at time t.
void SensorNoise::wander_to(double t_s) {
  if (noise_.slow_nT == 0) return;
  const double decay = wandering_ ? std::exp(-(t_s - t_s_) / noise_.slow_tau_s) : 0;
  for (double& w : wander_) w = decay * w + noise_.slow_nT * std::sqrt(1 - decay * decay) * normal_(random_);
  wandering_ = true;
  t_s_ = t_s;
}

double SensorNoise::one(std::size_t axis) {
  if (noise_.noise_nT == 0 && noise_.spike_share == 0) return 0;
  double& last = previous_.at(axis);
  const double fresh = draw(noise_.kind, noise_.student_dof);
  last = noise_.ar1_rho * last + std::sqrt(1 - noise_.ar1_rho * noise_.ar1_rho) * fresh;
  double out = noise_.noise_nT * last;
  if (noise_.spike_share > 0) {
    const double luck = std::uniform_real_distribution<double>(0, 1)(random_);
    if (luck < noise_.spike_share) out += luck < noise_.spike_share / 2 ? -noise_.spike_nT : noise_.spike_nT;
  }
  return out;
}

Eigen::Vector3d SensorNoise::sample(const Eigen::Vector3d& true_nT, double t_s) {
  if (visit_due_) draw_visit();
  wander_to(t_s);
  Eigen::Vector3d y_nT = true_nT;
  for (std::size_t a = 0; a < 3; ++a) {
    double& y = y_nT[static_cast<Eigen::Index>(a)];
    y += offset_.at(a) + wander_.at(a) + one(a);
    if (noise_.lsb_nT > 0) y = noise_.lsb_nT * std::round(y / noise_.lsb_nT);
  }
  return y_nT;
}

/// Mean of the slow part over a length that begins now; the part is left where the length ends. Both are
/// Gaussian, with the covariance of the process and its integral.
double SensorNoise::wander_mean(std::size_t axis, double length_s) {
  const double tau = noise_.slow_tau_s, L = length_s / tau, e = std::exp(-L);
  const double s2 = noise_.slow_nT * noise_.slow_nT;
  const double var_end = s2 * (1 - e * e), var_mean = s2 * (2 * L - 3 + 4 * e - e * e) / (L * L);
  const double covariance = s2 * (1 - e) * (1 - e) / L;
  double& w = wander_.at(axis);
  const double u = normal_(random_), v = normal_(random_);
  const double mean = w * (1 - e) / L + covariance / std::sqrt(var_end) * u +
                      std::sqrt(std::max(0.0, var_mean - covariance * covariance / var_end)) * v;
  w = e * w + std::sqrt(var_end) * u;
  return mean;
}

SensorNoise::Dwell SensorNoise::drawn(const Eigen::Vector3d& true_nT, double from_s, int n, double period_s) {
  Eigen::Vector3d sum(0, 0, 0), squares(0, 0, 0);
  for (int k = 0; k < n; ++k) {
    const Eigen::Vector3d d = sample(true_nT, from_s + k * period_s) - true_nT;
    sum += d;
    squares += d.cwiseAbs2();
  }
  Dwell out{true_nT + sum / n, {0, 0, 0}};
  if (n > 1) out.sd_nT = ((squares - sum.cwiseAbs2() / n) / (n - 1)).cwiseMax(0).cwiseSqrt();
  return out;
}

SensorNoise::Dwell SensorNoise::dwell(const Eigen::Vector3d& true_nT, double from_s, int n, double period_s) {
  const bool fine = noise_.lsb_nT <= 2 * noise_.noise_nT;  // dithered: no bias of 1e-8 lsb
  if (n < 8 || noise_.kind != NoiseKind::gaussian || noise_.ar1_rho != 0 || noise_.spike_share > 0 || !fine)
    return drawn(true_nT, from_s, n, period_s);
  if (visit_due_) draw_visit();
  wander_to(from_s);
  const double length_s = n * period_s;
  const double variance = noise_.noise_nT * noise_.noise_nT + noise_.lsb_nT * noise_.lsb_nT / 12;
  std::chi_squared_distribution<double> chi2(n - 1);
  Dwell out;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    double slow = wander_.at(a), within = variance;
    if (noise_.slow_nT > 0) {
      slow = wander_mean(a, length_s);
      const double L = length_s / noise_.slow_tau_s;  // what is left within the dwell, on average
      within += noise_.slow_nT * noise_.slow_nT * (1 - 2 * (L - 1 + std::exp(-L)) / (L * L));
    }
    out.mean_nT[axis] = true_nT[axis] + offset_.at(a) + slow + std::sqrt(variance / n) * normal_(random_);
    out.sd_nT[axis] = within > 0 ? std::sqrt(within * chi2(random_) / (n - 1)) : 0;
  }
  t_s_ = from_s + length_s;
  return out;
}

}  // namespace mgtd::rig
