// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "tests/rig/axis_motion.h"
#include "tests/rig/motion.h"
#include "tests/rig/noise.h"
#include "tests/rig/scenario.h"

/// The World is the physics of the rig: site, table, sensors, temperature. Everything is a function of the
/// simulated time, asked for by the instruments sample by sample. Knows the truth; nobody else does.
///
///   B(t, x)                                     site frame, x from the centre of the array
///   b_i = R B(t, R' r_i)                        R = M Rz(azimuth) Ry(pitch) Rx(roll), the angles as they
///                                               truly are, M the mounting of the array on the table;
///                                               or a Motion
///   y_i = C A R_i' b_i + I_i + noise            SensorTruth; effects at their levels (effect.h)
namespace mgtd::rig {

enum TableAxis : std::size_t { azimuth, pitch, roll };

class World {
 public:
  explicit World(Scenario scenario);

  [[nodiscard]] const Scenario& scenario() const { return scenario_; }

  [[nodiscard]] const AxisMotion& axis(TableAxis which) const { return axes_.at(which); }
  void set_velocity(TableAxis which, double deg_per_s) { axes_.at(which).set_velocity(deg_per_s); }
  void move(TableAxis which, double target_deg, double now_s);
  void halt(TableAxis which, double now_s);
  void set_jammed(bool jammed, double now_s);
  /// Sensor i (from 0 on) is turned by a quarter about the platform's z, and 0.7 deg more.
  void set_turned(int i, bool turned, double now_s);
  /// The azimuth turns by itself.
  void set_runaway(bool runaway, double now_s);
  [[nodiscard]] bool moving(double t_s) const;
  /// When the last of the axes stands.
  [[nodiscard]] double arrival_s() const;
  /// A bar magnet of 1 A m2 in a hand, 0.2 m beyond the end of the arm of a sensor (from 1 on); 0: put
  /// away. A sensor at the centre has its arm along X.
  void hold_magnet(int arm) {
    magnet_at_ = arm;
    moment_.known = false;
  }
  /// What passing vehicles add at the centre of the array, site frame.
  [[nodiscard]] Eigen::Vector3d vehicles_nT(double t_s, const Eigen::Vector3d& x_m) const;
  /// It is no table that carries the array from now on: R = Motion::attitude(t).
  void carry(std::shared_ptr<const Motion> motion);
  /// A cage makes this field in the place of the site's own; effects of the site remain.
  void set_cage(const Eigen::Vector3d& field_nT, double now_s);
  /// A coil leaves this share of the site's own field.
  void set_coil(double share, double now_s);
  /// What a hand or a heater does to the heads, with s the time since it began: they warm and cool again by
  /// p s/tau exp(1 - s/tau), or stay warmer, p (1 - exp(-s/tau)).
  struct Heating {
    double begin_s{0}, degC{0}, tau_s{1};
    int head{0};  ///< 1 ...; 0: all
    bool stays{false};
    [[nodiscard]] double degC_of(int of_head, double t_s) const;
  };
  void heat(const Heating& heating, double now_s);
  /// Puts the array on the table in another way, the table standing.
  void remount(const Eigen::Matrix3d& table_to_platform, double now_s);

  /// Noisy reading of connector i (from 0 on) at time t, nT at nominal scale. Times of one sensor must not go
  /// back.
  [[nodiscard]] Eigen::Vector3d read_sensor(int i, double t_s);
  /// The same without noise.
  [[nodiscard]] Eigen::Vector3d quiet_reading(int i, double t_s);
  [[nodiscard]] SensorNoise& noise(int i) { return noise_.at(sensor_at(i)); }
  [[nodiscard]] double head_degC(int i, double t_s) const;
  /// Noisy total field at the centre, and without noise.
  [[nodiscard]] double read_scalar(double t_s);
  [[nodiscard]] double quiet_scalar(double t_s) const;
  [[nodiscard]] double scalar_noise() { return scalar_noise_.next(); }
  /// What the vector reference reads, in its own axes, without noise; and what its noise is drawn from.
  [[nodiscard]] Eigen::Vector3d quiet_reference(double t_s) const;
  [[nodiscard]] Eigen::Vector3d reference_noise();
  /// What a perfect cross would say of the field right now, platform frame: xx, yy, zz, xy, xz, yz. Of any
  /// other array: what a cross of 0.4 m at its centre would say.
  [[nodiscard]] std::array<double, 6> true_gradient_nT_per_m(double t_s) const;
  /// Site frame to platform frame, by the true angles.
  [[nodiscard]] Eigen::Matrix3d attitude(double t_s) const { return moment(t_s).R; }
  [[nodiscard]] std::size_t sensors() const { return position_m_.size(); }

 private:
  /// Everything above the sensors at one time.
  struct Moment {
    double t_s{-1};
    bool known{false};
    double azimuth_deg{0};
    Eigen::Matrix3d R{Eigen::Matrix3d::Identity()};
    std::vector<Eigen::Vector3d> b_nT;
  };

  /// Standard normal numbers of one noise.
  struct NormalDraws {
    std::mt19937_64 random;
    std::normal_distribution<double> normal{};
    double next() { return normal(random); }
  };

  [[nodiscard]] const Moment& moment(double t_s) const;
  /// Attitude and azimuth by the table's true angles and the effects on them.
  void turn(double t_s) const;
  /// The field at a place in the platform frame, and that of the magnet in a hand.
  [[nodiscard]] Eigen::Vector3d field_at(double t_s, const Eigen::Vector3d& r_m) const;
  [[nodiscard]] Eigen::Vector3d hand_magnet_nT(const Eigen::Vector3d& r_m) const;
  [[nodiscard]] Eigen::Vector3d site_field(double t_s, const Eigen::Vector3d& x_m) const;
  /// C A R' b of sensor i with the platform's effects, nothing added.
  [[nodiscard]] Eigen::Vector3d seen(int i, double t_s) const;
  [[nodiscard]] AxisContext context(int i, double t_s) const;
  [[nodiscard]] double temperature(int sensor, double t_s) const;
  [[nodiscard]] std::size_t sensor_at(int connector) const {
    if (scenario_.copied > 0) return scenario_.copied - 1;
    return static_cast<std::size_t>(of_sensor(scenario_.wiring, static_cast<std::size_t>(connector)) - 1);
  }
  /// Shows what sensor i saw on the way up to t to the effects that remember.
  void follow(int i, double t_s);
  void follow_all(double t_s);
  void moved();

  Scenario scenario_;
  std::vector<std::unique_ptr<Effect>> effects_;
  std::vector<Effect*> remembering_;
  std::vector<double> followed_s_;
  std::array<AxisMotion, 3> axes_;
  std::vector<Eigen::Matrix3d> matrix_;
  std::vector<Eigen::Vector3d> position_m_;
  Eigen::Vector3d direction_;
  Eigen::Matrix3d mount_{Eigen::Matrix3d::Identity()};
  std::vector<SensorNoise> noise_;
  NormalDraws scalar_noise_, reference_noise_;
  std::mt19937_64 table_random_;
  std::shared_ptr<const Motion> motion_;
  std::optional<Eigen::Vector3d> cage_nT_;
  double coil_share_{1};
  std::vector<Heating> heatings_;
  mutable Moment moment_;
  int magnet_at_{0};
};

}  // namespace mgtd::rig
