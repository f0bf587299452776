// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/world.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/rig/rotations.h"

namespace mgtd::rig {
namespace {

/// Longest step of the path that an effect with memory is shown while the table moves.
constexpr double kPathEvery_s = 0.05;
constexpr double kTurned_deg = 90.7;
constexpr double kMagnet_Am2 = 1, kMagnetBeyond_m = 0.2;

AxisMotion make_axis(const Scenario& s) {
  return {s.table_velocity_deg_per_s, s.table_acceleration_deg_per_s2, s.table_accuracy_deg};
}

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

World::World(Scenario scenario)
    : scenario_(std::move(scenario)),
      axes_{make_axis(scenario_), make_axis(scenario_), make_axis(scenario_)},
      scalar_random_(noise_stream(scenario_.seed, 4)),
      table_random_(noise_stream(scenario_.seed, 5)) {
  for (const auto& effect : scenario_.effects) {
    effects_.push_back(effect->fresh());
    effects_.back()->begin(scenario_);
    if (effects_.back()->remembers()) remembering_.push_back(effects_.back().get());
  }
  const double h = scenario_.baseline_m / 2;
  position_m_ = {Eigen::Vector3d{h, 0, 0}, Eigen::Vector3d{0, h, 0}, Eigen::Vector3d{-h, 0, 0},
                 Eigen::Vector3d{0, -h, 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    matrix_.at(i) = scenario_.truth.at(i).matrix();
    noise_.emplace_back(scenario_.noise, scenario_.visit, scenario_.seed, static_cast<std::uint32_t>(i));
  }
  direction_ = scenario_.field_direction();
}

void World::moved() {
  moment_.known = false;
  for (SensorNoise& noise : noise_) noise.visit();
}

void World::remount(const Eigen::Matrix3d& table_to_platform, double now_s) {
  follow_all(now_s);
  mount_ = table_to_platform;
  moved();
}

void World::move(TableAxis which, double target_deg, double now_s) {
  follow_all(now_s);
  axes_.at(which).move_to(target_deg, now_s, table_random_);
  moved();
}

void World::halt(TableAxis which, double now_s) {
  follow_all(now_s);
  axes_.at(which).halt(now_s);
  moved();
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
  moved();
}

void World::set_turned(int i, bool turned, double now_s) {
  follow_all(now_s);
  matrix_.at(at(i)) = scenario_.truth.at(at(i)).matrix();
  if (turned) matrix_.at(at(i)) *= about_z(kTurned_deg);
  moved();
}

void World::set_runaway(bool runaway, double now_s) {
  follow_all(now_s);
  if (runaway) {
    axes_[azimuth].run_away(now_s);
  } else {
    axes_[azimuth].catch_up(now_s);
  }
  moved();
}

bool World::moving(double t_s) const {
  return std::any_of(axes_.begin(), axes_.end(), [&](const AxisMotion& axis) { return axis.moving(t_s); });
}

double World::arrival_s() const {
  return std::max({axes_[azimuth].end_s(), axes_[pitch].end_s(), axes_[roll].end_s()});
}

const World::Moment& World::moment(double t_s) const {
  if (moment_.known && moment_.t_s == t_s) return moment_;
  TableContext table;
  for (std::size_t a = 0; a < 3; ++a) {
    table.angle_deg.at(a) = axes_.at(a).true_deg(t_s);
    table.sense.at(a) = axes_.at(a).sense();
  }
  std::array<double, 3> angle_deg = table.angle_deg;
  Eigen::Vector3d tilt(0, 0, 0);
  for (const auto& effect : effects_) {
    const TableError error = effect->table(table);
    for (std::size_t a = 0; a < 3; ++a) angle_deg.at(a) += error.angle_deg.at(a);
    tilt += kDeg * Eigen::Vector3d(error.tilt_x_deg, error.tilt_y_deg, 0);
  }
  moment_.t_s = t_s;
  moment_.known = true;
  moment_.azimuth_deg = angle_deg[azimuth];
  moment_.R = mount_ * about_z(angle_deg[azimuth]) * turned_by(tilt) * about_y(angle_deg[pitch]) *
              about_x(angle_deg[roll]);
  for (std::size_t i = 0; i < 4; ++i)
    moment_.b_nT.at(i) = moment_.R * site_field(t_s, moment_.R.transpose() * position_m_.at(i));
  if (magnet_at_ > 0) {
    const Eigen::Vector3d& arm_m = position_m_.at(at(magnet_at_ - 1));
    const Eigen::Vector3d magnet_m = arm_m + kMagnetBeyond_m * arm_m.normalized();
    for (std::size_t i = 0; i < 4; ++i)
      moment_.b_nT.at(i) += dipole_nT(kMagnet_Am2 * Eigen::Vector3d::UnitZ(), position_m_.at(i) - magnet_m);
  }
  return moment_;
}

std::array<double, 6> World::true_gradient_nT_per_m(double t_s) const {
  const auto& b_nT = moment(t_s).b_nT;
  const Eigen::Vector3d along_x = (b_nT[0] - b_nT[2]) / (position_m_[0] - position_m_[2]).norm();
  const Eigen::Vector3d along_y = (b_nT[1] - b_nT[3]) / (position_m_[1] - position_m_[3]).norm();
  return {along_x[0], along_y[1], -along_x[0] - along_y[1], (along_x[1] + along_y[0]) / 2,
          along_x[2], along_y[2]};
}

Eigen::Vector3d World::site_field(double t_s, const Eigen::Vector3d& x_m) const {
  const double hours = t_s / 3600;
  const double day = std::sin(2 * std::numbers::pi * hours / scenario_.diurnal_period_h);
  const double f_nT = scenario_.f_nT + scenario_.field_drift_nT_per_h * hours + scenario_.diurnal_nT * day;
  Eigen::Vector3d B = f_nT * direction_;
  for (const auto& effect : effects_) B += effect->site_nT(t_s, x_m);
  for (const DroppedMagnet& magnet : scenario_.magnets) B += magnet.field_nT(t_s, x_m);
  return B + vehicles_nT(t_s, x_m);
}

Eigen::Vector3d World::vehicles_nT(double t_s, const Eigen::Vector3d& x_m) const {
  Eigen::Vector3d B(0, 0, 0);
  for (const Vehicle& vehicle : scenario_.vehicles) B += vehicle.field_nT(t_s, x_m, direction_);
  return B;
}

Eigen::Vector3d World::seen(int i, double t_s) const {
  const Moment& now = moment(t_s);
  const PlatformContext platform{i, t_s, temperature(i, t_s), now.R.col(2), mount_, now.b_nT, position_m_};
  Eigen::Vector3d added(0, 0, 0), omega(0, 0, 0);
  for (const auto& effect : effects_) {
    added += effect->platform_nT(platform);
    omega += effect->turn_rad(platform);
  }
  return matrix_.at(at(i)) * (turned_by(omega) * (now.b_nT.at(at(i)) + added));
}

AxisContext World::context(int i, double t_s) const {
  const Moment& now = moment(t_s);
  return {i, 0, t_s, temperature(i, t_s), seen(i, t_s), now.R.col(2), now.azimuth_deg};
}

void World::follow(int i, double t_s) {
  if (remembering_.empty()) return;
  double& done_s = followed_s_.at(at(i));
  while (done_s < t_s) {
    // A standing table is left at once; what else changes, changes slowly.
    done_s = moving(done_s) ? std::min(t_s, done_s + kPathEvery_s) : t_s;
    AxisContext now = context(i, done_s);
    for (now.axis = 0; now.axis < 3; ++now.axis) {
      for (Effect* effect : remembering_) effect->follow(now);
    }
  }
}

void World::follow_all(double t_s) {
  if (remembering_.empty()) return;
  // In step, so that the four share what is above the sensors.
  for (double t = *std::min_element(followed_s_.begin(), followed_s_.end()); t < t_s;) {
    t = moving(t) ? std::min(t_s, t + kPathEvery_s) : t_s;
    for (int i = 0; i < 4; ++i) follow(i, t);
  }
}

Eigen::Vector3d World::quiet_reading(int i, double t_s) {
  const int sensor = static_cast<int>(sensor_at(i));
  follow(sensor, t_s);
  AxisContext now = context(sensor, t_s);
  Eigen::Vector3d y_nT = now.v_nT + scenario_.truth.at(at(sensor)).offset_nT;
  for (now.axis = 0; now.axis < 3; ++now.axis) {
    for (const auto& effect : effects_) y_nT[now.axis] += effect->axis_nT(now);
  }
  return y_nT;
}

Eigen::Vector3d World::read_sensor(int i, double t_s) {
  const Eigen::Vector3d y_nT = quiet_reading(i, t_s);
  return noise(i).sample(y_nT, t_s);
}

double World::temperature(int sensor, double t_s) const {
  const TemperatureScript& s = scenario_.temperature;
  double out = s.start_degC + s.ramp_degC_per_h * t_s / 3600 + s.head_degC.at(at(sensor));
  const double since = (t_s - s.pulse_at_s) / s.pulse_tau_s;
  if (since > 0 && (s.pulse_head == 0 || s.pulse_head == at(sensor) + 1))
    out += s.pulse_degC * since * std::exp(1 - since);
  return out;
}

double World::head_degC(int i, double t_s) const { return temperature(static_cast<int>(sensor_at(i)), t_s); }

double World::quiet_scalar(double t_s) const {
  const Eigen::Vector3d B = site_field(t_s, Eigen::Vector3d::Zero());
  const Eigen::Vector3d u = moment(t_s).R * B.normalized();
  double out = B.norm();
  for (const auto& effect : effects_) out += effect->reference_nT(u);
  return out;
}

double World::read_scalar(double t_s) {
  return quiet_scalar(t_s) + scenario_.scalar_noise_nT * scalar_noise();
}

}  // namespace mgtd::rig
