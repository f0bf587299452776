// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

/// A hidden effect: what the rig does and nobody told the estimator. It acts at one physical level, sample by
/// sample. A new one is a class below tests/rig/effects and a line in effect_list.cc.
namespace mgtd::rig {

inline constexpr double kF0_nT = 50'000;  ///< normaliser of the nonlinear terms
inline constexpr double kT0_degC = 20;

struct AxisContext {
  int sensor{0};  ///< 0 .. 3
  int axis{0};    ///< 0 .. 2
  double t_s{0};
  double T_degC{kT0_degC};
  /// What the three axes see: scale, non-orthogonality and mounting included, offset not.
  Eigen::Vector3d v_nT{0, 0, 0};
  [[nodiscard]] double v() const { return v_nT[axis]; }
  [[nodiscard]] double x() const { return v_nT[axis] / kF0_nT; }
};

struct TableContext {
  std::array<double, 3> angle_deg{};  ///< azimuth, pitch, roll, with the table's random error
  std::array<int, 3> sense{};         ///< of the last move
};

class Effect {
 public:
  virtual ~Effect() = default;
  /// A copy that has seen nothing yet of what this one remembers.
  [[nodiscard]] virtual std::unique_ptr<Effect> fresh() const = 0;
  /// Level of the site: field added at position x (m, site frame, from the centre of the array).
  [[nodiscard]] virtual Eigen::Vector3d site_nT(double /*t_s*/, const Eigen::Vector3d& /*x_m*/) const {
    return Eigen::Vector3d::Zero();
  }
  /// Level of the table: added to the azimuth.
  [[nodiscard]] virtual double azimuth_deg(const TableContext& /*context*/) const { return 0; }
  /// Level of the axis: added to the reading.
  [[nodiscard]] virtual double axis_nT(const AxisContext& /*context*/) const { return 0; }
  /// Whether the past matters; then follow() sees every axis along the whole path, in the order of time, the
  /// sample itself included, before axis_nT() is asked.
  [[nodiscard]] virtual bool remembers() const { return false; }
  virtual void follow(const AxisContext& /*context*/) {}
  /// Name, coefficients and units, for the sealed truth.
  [[nodiscard]] virtual nlohmann::json truth() const = 0;

 protected:
  Effect() = default;
  Effect(const Effect&) = default;
  Effect& operator=(const Effect&) = default;
};

/// Which axes an effect acts on: "all", "s3" or "s3.z".
class Where {
 public:
  Where() = default;
  /// Empty optional when the text names none.
  [[nodiscard]] static std::optional<Where> parse(const std::string& text);
  [[nodiscard]] bool covers(const AxisContext& c) const {
    return (sensor_ < 0 || c.sensor == sensor_) && (axis_ < 0 || c.axis == axis_);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_{"all"};
  int sensor_{-1}, axis_{-1};
};

}  // namespace mgtd::rig
