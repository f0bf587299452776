// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

/// A hidden effect: what the rig does and nobody told the estimator. It acts at one physical level, sample by
/// sample.
namespace mgtd::rig {

inline constexpr double kF0_nT = 50'000;  ///< normaliser of the nonlinear terms
inline constexpr double kT0_degC = 20;

struct AxisContext {
  int sensor{0};  ///< 0 .. 3
  int axis{0};    ///< 0 .. 2
  double t_s{0};
  double T_degC{20};
  Eigen::Vector3d v_nT{0, 0,
                       0};  ///< what the three axes see, scale and non-orthogonality included, offset not
};

class Effect {
 public:
  virtual ~Effect() = default;
  /// Level of the site: field added at position x (m, site frame, from the centre of the array).
  [[nodiscard]] virtual Eigen::Vector3d site_nT(double /*t_s*/, const Eigen::Vector3d& /*x_m*/) const {
    return Eigen::Vector3d::Zero();
  }
  /// Level of the axis: added to the reading. May remember the path (hysteresis), so samples come in order of
  /// time.
  [[nodiscard]] virtual double axis_nT(const AxisContext& /*context*/) { return 0; }
  /// Name, coefficients and units, for the sealed truth.
  [[nodiscard]] virtual nlohmann::json truth() const = 0;
};

/// Which axes an effect acts on: "all", "s3" or "s3.z".
class Where {
 public:
  Where() = default;
  /// Empty optional when the text names none.
  [[nodiscard]] static std::optional<Where> parse(const std::string& text);
  [[nodiscard]] bool covers(int sensor, int axis) const {
    return (sensor_ < 0 || sensor == sensor_) && (axis_ < 0 || axis == axis_);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_{"all"};
  int sensor_{-1}, axis_{-1};
};

}  // namespace mgtd::rig
