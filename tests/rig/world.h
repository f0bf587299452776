// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <random>
#include <vector>

#include "tests/rig/axis_motion.h"
#include "tests/rig/scenario.h"

/// The physics of the rig: site, table, sensors, temperature. Everything is a function of the simulated time,
/// asked for by the instruments sample by sample. Knows the truth; nobody else does.
///
///   B(t, x)                                     site frame, x from the centre of the array
///   b_i = T B(t, T' r_i)                        T = Rz(azimuth) Ry(pitch) Rx(roll), the angles as they truly
///   are y_i = M_i b_i + I_i + effects + noise       M_i from SensorTruth
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
  [[nodiscard]] bool moving(double t_s) const;

  /// Noisy reading of sensor i (0 .. 3) at time t, nT at nominal scale. Times of one sensor must not go back.
  [[nodiscard]] Eigen::Vector3d read_sensor(int i, double t_s);
  [[nodiscard]] double head_degC(int i, double t_s) const;
  /// Noisy total field at the centre.
  [[nodiscard]] double read_scalar(double t_s);
  /// Site frame to platform frame, by the true angles.
  [[nodiscard]] Eigen::Matrix3d attitude(double t_s) const;

 private:
  /// A stream of its own per source, so that how often one is asked does not change the others.
  struct NoiseSource {
    std::mt19937_64 random;
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform{-1, 1};
  };

  [[nodiscard]] Eigen::Vector3d site_field(double t_s, const Eigen::Vector3d& x_m) const;
  /// C A R' b of sensor i, nothing added.
  [[nodiscard]] Eigen::Vector3d seen(int i, double t_s) const;
  /// Shows what sensor i saw on the way up to t to the effects that remember.
  void follow(int i, double t_s);
  void follow_all(double t_s);
  [[nodiscard]] double noise(NoiseSource& source) const;

  Scenario scenario_;
  std::vector<std::unique_ptr<Effect>> effects_;
  bool remember_{false};
  std::array<double, 4> followed_s_{};
  std::array<AxisMotion, 3> axes_;
  std::array<Eigen::Matrix3d, 4> matrix_;
  std::array<Eigen::Vector3d, 4> position_m_;
  Eigen::Vector3d direction_;
  std::array<NoiseSource, 4> sensor_noise_;
  NoiseSource scalar_noise_;
  std::mt19937_64 table_random_;
};

}  // namespace mgtd::rig
