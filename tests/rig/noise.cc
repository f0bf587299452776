// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mgtd::rig {
namespace {

std::vector<SlowProcess> slow_parts(const SampleNoise& n) {
  std::vector<SlowProcess> out;
  if (n.slow_nT > 0) out.push_back(SlowProcess::wandering(n.slow_nT, n.slow_tau_s));
  if (n.walk_nT_per_sqrt_h > 0) out.push_back(SlowProcess::walk(n.walk_nT_per_sqrt_h));
  if (n.flicker_nT_per_sqrt_hz > 0) {
    const auto parts = flicker(n.flicker_nT_per_sqrt_hz);
    out.insert(out.end(), parts.begin(), parts.end());
  }
  return out;
}

/// 4 to 6 are of other instruments, 16 to 19 of the cross's visits, 32 to 47 of what else is drawn.
std::uint32_t stream_of(std::uint32_t sensor) { return sensor < kCross ? sensor : 64 + sensor; }

}  // namespace

std::mt19937_64 noise_stream(std::uint64_t seed, std::uint32_t which) {
  std::seed_seq words{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U), which};
  return std::mt19937_64(words);
}

SensorNoise::SensorNoise(const SampleNoise& sample, const VisitNoise& visit, std::uint64_t seed,
                         std::uint32_t sensor)
    : noise_(sample),
      visit_noise_(visit),
      random_(noise_stream(seed, stream_of(sensor))),
      visit_random_(noise_stream(seed, stream_of(sensor) + 16)),
      sensor_(static_cast<int>(sensor)) {
  slow_.fill(slow_parts(sample));
}

/// Unit sd, except uniform: half width one.
double SensorNoise::draw(NoiseKind kind, double dof) {
  if (kind == NoiseKind::uniform) return std::uniform_real_distribution<double>(-1, 1)(random_);
  if (kind == NoiseKind::gaussian) return normal_(random_);
  return std::student_t_distribution<double>(dof)(random_) * std::sqrt((dof - 2) / dof);
}

void SensorNoise::draw_visit() {
  visit_due_ = false;
  const VisitNoise& v = visit_noise_;
  const double turns = visits_++ / v.cycle_visits;
  if (v.noise_nT == 0 && v.outlier_share == 0 && v.cycle_nT == 0) return;
  std::swap(random_, visit_random_);  // visits have a stream of their own
  for (std::size_t a = 0; a < 3; ++a) {
    const double fresh = draw(v.kind, v.student_dof);
    between_visits_.at(a) =
        begun_ ? v.rho * between_visits_.at(a) + std::sqrt(1 - v.rho * v.rho) * fresh : fresh;
    offset_.at(a) = v.noise_nT * between_visits_.at(a);
    if (v.cycle_where.covers({.sensor = sensor_, .axis = static_cast<int>(a)}))
      offset_.at(a) += v.cycle_nT * std::cos(2 * std::numbers::pi * turns);
    std::uniform_real_distribution<double> unit(0, 1);
    const double luck = unit(random_);
    if (luck < v.outlier_share) offset_.at(a) += luck < v.outlier_share / 2 ? -v.outlier_nT : v.outlier_nT;
  }
  normal_.reset();
  std::swap(random_, visit_random_);
  begun_ = true;
}

/// The slow parts at time t.
void SensorNoise::wander_to(double t_s) {
  if (slow_[0].empty() || (wandering_ && t_s <= t_s_)) return;
  for (auto& axis : slow_) {
    for (SlowProcess& part : axis) {
      if (wandering_) {
        part.advance(t_s - t_s_, random_, normal_);
      } else {
        part.begin(random_, normal_);
      }
    }
  }
  wandering_ = true;
  t_s_ = t_s;
}

double SensorNoise::slow_nT(std::size_t axis) const {
  double out = 0;
  for (const SlowProcess& part : slow_.at(axis)) out += part.value_nT();
  return out;
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
    y += offset_.at(a) + slow_nT(a) + one(a);
    if (noise_.lsb_nT > 0) y = noise_.lsb_nT * std::round(y / noise_.lsb_nT);
  }
  return y_nT;
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
  const bool fine = noise_.lsb_nT <= noise_.noise_nT;  // dithered: a bias of 1e-9 lsb
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
    double slow = 0, within = variance;
    for (SlowProcess& part : slow_.at(a)) {
      slow += part.mean_over(length_s, random_, normal_);
      within += part.variance_within(length_s);
    }
    out.mean_nT[axis] = true_nT[axis] + offset_.at(a) + slow + std::sqrt(variance / n) * normal_(random_);
    out.sd_nT[axis] = within > 0 ? std::sqrt(within * chi2(random_) / (n - 1)) : 0;
  }
  t_s_ = from_s + length_s;
  return out;
}

}  // namespace mgtd::rig
