// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/world.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tests/rig/rotations.h"

namespace mgtd::rig {
namespace {

/// Longest step of the path that an effect with memory is shown while the table moves.
constexpr double kPathEvery_s = 0.05;
constexpr double kTurned_deg = 90.7;
constexpr double kCross_m = 0.2;  ///< arm of the cross that would measure any other array's gradient
constexpr double kMagnet_Am2 = 1, kMagnetBeyond_m = 0.2;

AxisMotion make_axis(const Scenario& s) {
  return {s.table_velocity_deg_per_s, s.table_acceleration_deg_per_s2, s.table_accuracy_deg};
}

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

World::World(Scenario scenario)
    : scenario_(std::move(scenario)),
      axes_{make_axis(scenario_), make_axis(scenario_), make_axis(scenario_)},
      scalar_noise_{noise_stream(scenario_.seed, 4)},
      reference_noise_{noise_stream(scenario_.seed, 6)},
      table_random_(noise_stream(scenario_.seed, 5)) {
  for (const auto& effect : scenario_.effects) {
    effects_.push_back(effect->fresh());
    effects_.back()->begin(scenario_);
    if (effects_.back()->remembers()) remembering_.push_back(effects_.back().get());
  }
  position_m_ = scenario_.places_m();
  if (position_m_.size() != scenario_.sensors())
    throw std::invalid_argument("a scenario needs one place for each of its sensors");
  moment_.b_nT.resize(sensors());
  followed_s_.resize(sensors());
  for (std::size_t i = 0; i < sensors(); ++i) {
    matrix_.push_back(scenario_.truth[i].matrix());
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

void World::carry(std::shared_ptr<const Motion> motion) {
  motion_ = std::move(motion);
  moved();
}

void World::set_cage(const Eigen::Vector3d& field_nT, double now_s) {
  follow_all(now_s);
  cage_nT_ = field_nT;
  moved();
}

void World::set_coil(double share, double now_s) {
  follow_all(now_s);
  coil_share_ = share;
  moved();
}

void World::heat(const Heating& heating, double now_s) {
  follow_all(now_s);
  heatings_.push_back(heating);
  moved();
}

double World::Heating::degC_of(int of_head, double t_s) const {
  const double since = (t_s - begin_s) / tau_s;
  if (since <= 0 || (head != 0 && head != of_head)) return 0;
  return stays ? degC * (1 - std::exp(-since)) : degC * since * std::exp(1 - since);
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
  if (motion_ != nullptr) return true;
  return std::any_of(axes_.begin(), axes_.end(), [&](const AxisMotion& axis) { return axis.moving(t_s); });
}

double World::arrival_s() const {
  return std::max({axes_[azimuth].end_s(), axes_[pitch].end_s(), axes_[roll].end_s()});
}

void World::turn(double t_s) const {
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
  moment_.azimuth_deg = angle_deg[azimuth];
  moment_.R = mount_ * about_z(angle_deg[azimuth]) * turned_by(tilt) * about_y(angle_deg[pitch]) *
              about_x(angle_deg[roll]);
}

const World::Moment& World::moment(double t_s) const {
  if (moment_.known && moment_.t_s == t_s) return moment_;
  moment_.t_s = t_s;
  moment_.known = true;
  if (motion_ != nullptr) {
    moment_.R = motion_->attitude(t_s);
    moment_.azimuth_deg = std::atan2(-moment_.R(1, 0), moment_.R(0, 0)) / kDeg;
  } else {
    turn(t_s);
  }
  for (std::size_t i = 0; i < sensors(); ++i) moment_.b_nT[i] = field_at(t_s, position_m_[i]);
  return moment_;
}

Eigen::Vector3d World::field_at(double t_s, const Eigen::Vector3d& r_m) const {
  Eigen::Vector3d b_nT = moment_.R * site_field(t_s, moment_.R.transpose() * r_m);
  if (magnet_at_ > 0) b_nT += hand_magnet_nT(r_m);
  return b_nT;
}

Eigen::Vector3d World::hand_magnet_nT(const Eigen::Vector3d& r_m) const {
  const Eigen::Vector3d& arm_m = position_m_.at(at(magnet_at_ - 1));
  const Eigen::Vector3d out = arm_m.norm() > 0 ? arm_m.normalized() : Eigen::Vector3d::UnitX();
  return dipole_nT(kMagnet_Am2 * Eigen::Vector3d::UnitZ(), r_m - (arm_m + kMagnetBeyond_m * out));
}

std::array<double, 6> World::true_gradient_nT_per_m(double t_s) const {
  std::vector<Eigen::Vector3d> b_nT = moment(t_s).b_nT, r_m = position_m_;
  if (!scenario_.is_cross()) {
    r_m = {kCross_m * Eigen::Vector3d::UnitX(), kCross_m * Eigen::Vector3d::UnitY(),
           -kCross_m * Eigen::Vector3d::UnitX(), -kCross_m * Eigen::Vector3d::UnitY()};
    b_nT.clear();
    for (const Eigen::Vector3d& r : r_m) b_nT.push_back(field_at(t_s, r));
  }
  const Eigen::Vector3d along_x = (b_nT[0] - b_nT[2]) / (r_m[0] - r_m[2]).norm();
  const Eigen::Vector3d along_y = (b_nT[1] - b_nT[3]) / (r_m[1] - r_m[3]).norm();
  return {along_x[0], along_y[1], -along_x[0] - along_y[1], (along_x[1] + along_y[0]) / 2,
          along_x[2], along_y[2]};
}

Eigen::Vector3d World::site_field(double t_s, const Eigen::Vector3d& x_m) const {
  const double hours = t_s / 3600;
  const double day = std::sin(2 * std::numbers::pi * hours / scenario_.diurnal_period_h);
  const double f_nT = scenario_.f_nT + scenario_.field_drift_nT_per_h * hours + scenario_.diurnal_nT * day;
  Eigen::Vector3d B = cage_nT_.value_or(coil_share_ * f_nT * direction_);
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
  // In step, so that they share what is above the sensors.
  for (double t = *std::min_element(followed_s_.begin(), followed_s_.end()); t < t_s;) {
    t = moving(t) ? std::min(t_s, t + kPathEvery_s) : t_s;
    for (std::size_t i = 0; i < sensors(); ++i) follow(static_cast<int>(i), t);
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
  double out = s.start_degC + s.ramp_degC_per_h * t_s / 3600 + of_sensor(s.head_degC, at(sensor));
  const int head = sensor + 1;
  out +=
      Heating{s.pulse_at_s, s.pulse_degC, s.pulse_tau_s, static_cast<int>(s.pulse_head)}.degC_of(head, t_s);
  for (const Heating& heating : heatings_) out += heating.degC_of(head, t_s);
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

Eigen::Vector3d World::quiet_reference(double t_s) const {
  const VectorReference reference = scenario_.reference.value_or(VectorReference{});
  const Eigen::Vector3d B = site_field(t_s, Eigen::Vector3d(reference.at_m.data()));
  const Eigen::Vector3d seen = reference.on_platform ? Eigen::Vector3d(moment(t_s).R * B) : B;
  return reference.R().transpose() * seen;
}

Eigen::Vector3d World::reference_noise() {
  Eigen::Vector3d out;
  for (double& component : out) component = reference_noise_.next();
  return out;
}

double World::read_scalar(double t_s) {
  return quiet_scalar(t_s) + scenario_.scalar_noise_nT * scalar_noise();
}

}  // namespace mgtd::rig
