// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>

/// An Effect is something that the rig does and the estimator is not told. It acts at one physical level,
/// sample by sample:
///
///   site       B(t, x) += ...                       nT, site frame (Z down), x from the centre of the array
///   table      azimuth, pitch, roll and two tilts of the azimuth's axis += ...
///   platform   b_i <- exp[-omega_i]x b_i + ...      b_i = R B(t, R' r_i); omega_i turns the sensor
///   axis       y += ...                             what is read, nT
///   reference  f += ...                             what the scalar magnetometer reads, nT
///
/// A new one is an entry of a list below tests/rig/effects (effect_kind.h).
namespace mgtd::rig {

struct Scenario;

inline constexpr double kF0_nT = 50'000;  ///< normaliser of the nonlinear terms
inline constexpr double kT0_degC = 20;
inline constexpr std::size_t kMostPlaces = 16;  ///< sensors that an array can have
inline constexpr std::size_t kCross = 4;        ///< sensors of the cross

struct AxisContext {
  int sensor{0};  ///< counted from 0
  int axis{0};    ///< 0 .. 2
  double t_s{0};
  double T_degC{kT0_degC};
  /// What the three axes see: scale, non-orthogonality and mounting included, offset not.
  Eigen::Vector3d v_nT{0, 0, 0};
  Eigen::Vector3d g{0, 0, 1};  ///< unit gravity, platform frame
  double azimuth_deg{0};       ///< as it truly is, not wrapped
  [[nodiscard]] double v() const { return v_nT[axis]; }
  [[nodiscard]] double x() const { return v_nT[axis] / kF0_nT; }
  /// Of the k-th of the other two axes, in the order x, y, z.
  [[nodiscard]] double other(int k) const { return v_nT[axis <= k ? k + 1 : k] / kF0_nT; }
};

struct TableContext {
  std::array<double, 3> angle_deg{};  ///< azimuth, pitch, roll, with the table's random error
  std::array<int, 3> sense{};         ///< of the last move
};

/// R = M Rz(azimuth) exp(tilts) Ry(pitch) Rx(roll), M the mounting of the array on the table.
struct TableError {
  std::array<double, 3> angle_deg{};
  double tilt_x_deg{0}, tilt_y_deg{0};
};

struct PlatformContext {
  int sensor{0};
  double t_s{0};
  double T_degC{kT0_degC};
  Eigen::Vector3d g{0, 0, 1};
  Eigen::Matrix3d mount{Eigen::Matrix3d::Identity()};  ///< table frame to platform frame
  std::span<const Eigen::Vector3d> b_nT{};             ///< of every sensor before this level
  std::span<const Eigen::Vector3d> position_m{};       ///< platform frame
};

class Effect {
 public:
  virtual ~Effect() = default;
  /// A copy that has seen nothing yet of what this one remembers.
  [[nodiscard]] virtual std::unique_ptr<Effect> fresh() const = 0;
  /// Before the first sample of a rig: what it takes from the scenario (covariates, the seed).
  virtual void begin(const Scenario& /*scenario*/) {}
  [[nodiscard]] virtual Eigen::Vector3d site_nT(double /*t_s*/, const Eigen::Vector3d& /*x_m*/) const {
    return Eigen::Vector3d::Zero();
  }
  [[nodiscard]] virtual TableError table(const TableContext& /*context*/) const { return {}; }
  [[nodiscard]] virtual Eigen::Vector3d platform_nT(const PlatformContext& /*context*/) const {
    return Eigen::Vector3d::Zero();
  }
  /// omega_i, rad.
  [[nodiscard]] virtual Eigen::Vector3d turn_rad(const PlatformContext& /*context*/) const {
    return Eigen::Vector3d::Zero();
  }
  [[nodiscard]] virtual double axis_nT(const AxisContext& /*context*/) const { return 0; }
  /// `u`: direction of the field at the centre, platform frame.
  [[nodiscard]] virtual double reference_nT(const Eigen::Vector3d& /*u*/) const { return 0; }
  /// Whether the past matters; then follow() sees every axis along the whole path, in the order of time, the
  /// sample itself included, before axis_nT() is asked.
  [[nodiscard]] virtual bool remembers() const { return false; }
  virtual void follow(const AxisContext& /*context*/) {}
  /// The covariate that it needs; empty when none.
  [[nodiscard]] virtual std::string covariate() const { return {}; }
  /// Name, coefficients and units, for the sealed truth.
  [[nodiscard]] virtual nlohmann::json truth() const = 0;

 protected:
  Effect() = default;
  Effect(const Effect&) = default;
  Effect& operator=(const Effect&) = default;
};

/// Derive as `class Mine final : public EffectOf<Mine>`: a copy of what a scenario holds is a fresh one,
/// since only copies are ever shown anything.
template <class Self>
class EffectOf : public Effect {
 public:
  [[nodiscard]] std::unique_ptr<Effect> fresh() const final {
    return std::make_unique<Self>(static_cast<const Self&>(*this));
  }
};

/// Which axes an effect acts on: "all", "s3" or "s3.z".
class Where {
 public:
  Where() = default;
  /// Empty optional when the text names none of so many sensors.
  [[nodiscard]] static std::optional<Where> parse(const std::string& text, std::size_t sensors = kCross);
  [[nodiscard]] bool covers_sensor(int sensor) const { return sensor_ < 0 || sensor == sensor_; }
  [[nodiscard]] bool covers(const AxisContext& c) const {
    return covers_sensor(c.sensor) && (axis_ < 0 || c.axis == axis_);
  }
  [[nodiscard]] bool one_axis() const { return axis_ >= 0; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_{"all"};
  int sensor_{-1}, axis_{-1};
};

}  // namespace mgtd::rig
