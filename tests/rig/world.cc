// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/world.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/rig/rotations.h"

namespace mgtd::rig {
namespace {

/// Longest step of the path that an effect with memory is shown while the table moves.
constexpr double kPathStep_s = 0.02;

AxisMotion make_axis(const Scenario& s) {
  return {s.table_velocity_deg_per_s, s.table_acceleration_deg_per_s2, s.table_accuracy_deg};
}

/// Neighbouring seeds give unrelated streams.
std::mt19937_64 stream(std::uint64_t seed, std::uint32_t which) {
  std::seed_seq words{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U), which};
  return std::mt19937_64(words);
}

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

World::World(Scenario scenario)
    : scenario_(std::move(scenario)),
      axes_{make_axis(scenario_), make_axis(scenario_), make_axis(scenario_)},
      scalar_noise_{stream(scenario_.seed, 4), {}, {}},
      table_random_(stream(scenario_.seed, 5)) {
  for (const auto& effect : scenario_.effects) effects_.push_back(effect->fresh());
  remember_ = std::any_of(effects_.begin(), effects_.end(), [](const auto& e) { return e->remembers(); });
  const double h = scenario_.baseline_m / 2;
  position_m_ = {Eigen::Vector3d{h, 0, 0}, Eigen::Vector3d{0, h, 0}, Eigen::Vector3d{-h, 0, 0},
                 Eigen::Vector3d{0, -h, 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    matrix_.at(i) = scenario_.truth.at(i).matrix();
    sensor_noise_.at(i).random = stream(scenario_.seed, static_cast<std::uint32_t>(i));
  }
  const double inclination = scenario_.inclination_deg * kDeg, declination = scenario_.declination_deg * kDeg;
  direction_ = {std::cos(inclination) * std::cos(declination), std::cos(inclination) * std::sin(declination),
                std::sin(inclination)};
}

void World::move(TableAxis which, double target_deg, double now_s) {
  follow_all(now_s);
  axes_.at(which).move_to(target_deg, now_s, table_random_);
}

void World::halt(TableAxis which, double now_s) {
  follow_all(now_s);
  axes_.at(which).halt(now_s);
}

void World::set_jammed(bool jammed, double now_s) {
  follow_all(now_s);
  for (AxisMotion& axis : axes_) {
    if (jammed) {
      axis.jam(now_s);
    } else {
      axis.release(now_s);
    }
  }
}

bool World::moving(double t_s) const {
  return std::any_of(axes_.begin(), axes_.end(), [&](const AxisMotion& axis) { return axis.moving(t_s); });
}

Eigen::Matrix3d World::attitude(double t_s) const {
  TableContext table;
  for (std::size_t a = 0; a < 3; ++a) {
    table.angle_deg.at(a) = axes_.at(a).true_deg(t_s);
    table.sense.at(a) = axes_.at(a).sense();
  }
  double azimuth_deg = table.angle_deg[azimuth];
  for (const auto& effect : effects_) azimuth_deg += effect->azimuth_deg(table);
  return about_z(azimuth_deg) * about_y(table.angle_deg[pitch]) * about_x(table.angle_deg[roll]);
}

Eigen::Vector3d World::site_field(double t_s, const Eigen::Vector3d& x_m) const {
  const double hours = t_s / 3600;
  const double day = std::sin(2 * std::numbers::pi * hours / scenario_.diurnal_period_h);
  const double f_nT = scenario_.f_nT + scenario_.field_drift_nT_per_h * hours + scenario_.diurnal_nT * day;
  Eigen::Vector3d B = f_nT * direction_;
  for (const auto& effect : effects_) B += effect->site_nT(t_s, x_m);
  return B;
}

Eigen::Vector3d World::seen(int i, double t_s) const {
  const Eigen::Matrix3d T = attitude(t_s);
  return matrix_.at(at(i)) * (T * site_field(t_s, T.transpose() * position_m_.at(at(i))));
}

void World::follow(int i, double t_s) {
  if (!remember_) return;
  double& done_s = followed_s_.at(at(i));
  while (done_s < t_s) {
    // A standing table is left at once; what else changes, changes slowly.
    done_s = moving(done_s) ? std::min(t_s, done_s + kPathStep_s) : t_s;
    const Eigen::Vector3d v_nT = seen(i, done_s);
    for (int a = 0; a < 3; ++a) {
      const AxisContext context{i, a, done_s, head_degC(i, done_s), v_nT};
      for (const auto& effect : effects_) effect->follow(context);
    }
  }
}

void World::follow_all(double t_s) {
  for (int i = 0; i < 4; ++i) follow(i, t_s);
}

double World::noise(NoiseSource& source) const {
  if (scenario_.noise_nT == 0) return 0;
  return scenario_.noise_nT * (scenario_.noise == NoiseKind::gaussian ? source.normal(source.random)
                                                                      : source.uniform(source.random));
}

Eigen::Vector3d World::read_sensor(int i, double t_s) {
  follow(i, t_s);
  const Eigen::Vector3d v_nT = seen(i, t_s);
  Eigen::Vector3d y_nT = v_nT + scenario_.truth.at(at(i)).offset_nT;
  for (int a = 0; a < 3; ++a) {
    const AxisContext context{i, a, t_s, head_degC(i, t_s), v_nT};
    for (const auto& effect : effects_) y_nT[a] += effect->axis_nT(context);
    y_nT[a] += noise(sensor_noise_.at(at(i)));
  }
  return y_nT;
}

double World::head_degC(int i, double t_s) const {
  const TemperatureScript& s = scenario_.temperature;
  double out = s.start_degC + s.ramp_degC_per_h * t_s / 3600 + s.head_degC.at(at(i));
  const double since = (t_s - s.pulse_at_s) / s.pulse_tau_s;
  if (since > 0 && (s.pulse_head == 0 || s.pulse_head == at(i) + 1))
    out += s.pulse_degC * since * std::exp(1 - since);
  return out;
}

double World::read_scalar(double t_s) {
  const double noise_nT = scenario_.scalar_noise_nT * scalar_noise_.normal(scalar_noise_.random);
  return site_field(t_s, Eigen::Vector3d::Zero()).norm() + noise_nT;
}

}  // namespace mgtd::rig
