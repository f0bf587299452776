// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/effects/effect.h"
#include "proto/units.h"

/// These effects describe how the table stands off from where its angles say. Input and output: azimuth,
/// pitch, roll, two tilts of the azimuth axis (sensor_equations.h, table_rotation).
///
///     table.eccentricity  azimuth += e1 cos az + e2 sin az + e3 cos 2az + e4 sin 2az     deg
///     table.angle-scale   azimuth += 1e-6 kappa azimuth     ppm; azimuth as recorded, whole turns included
///     table.backlash      azimuth += beta sense             deg; sense = +-1 of the last approach
///     table.wobble        axis tilts by w1 cos az + w2 sin az about X, w2 cos az - w1 sin az about Y     deg
///
/// Of the four numbers of a general wobble (cos and sin about X and Y) the other two turn the array on the
/// table by a fixed rotation, which is part of the alignment of the sensors.
namespace mgtd::calib::effects::laws {

/// The common part: a name, coefficients that act on the array as a whole.
template <class Self>
class TableEffect : public EffectOf<Self> {
 public:
  [[nodiscard]] std::string_view name() const override { return Self::kName; }
  [[nodiscard]] Level level() const override { return Level::table; }
  [[nodiscard]] const std::vector<Coefficient>& coefficients() const override { return coefficients_; }
  [[nodiscard]] std::span<const int> at(int) const override { return all_; }
  [[nodiscard]] std::string_view missing(const Pose& pose) const override { return missing_angle(pose); }

 protected:
  TableEffect(std::initializer_list<const char*> names, const char* unit, double typical) {
    for (const char* name : names) {
      all_.push_back(static_cast<int>(coefficients_.size()));
      coefficients_.push_back({.name = name, .unit = unit, .typical = typical});
    }
  }

 private:
  std::vector<Coefficient> coefficients_;
  std::vector<int> all_;
};

class Eccentricity final : public TableEffect<Eccentricity> {
 public:
  static constexpr std::string_view kName = "table.eccentricity";
  Eccentricity() : TableEffect({"cos", "sin", "cos2", "sin2"}, "deg", 0.02) {}
  template <class S>
  void equation(const Conditions&, int, std::span<const S> in, std::span<const S> e, std::span<S> out) const {
    using std::cos, std::sin;
    const S& az = in[0];
    out[0] = (e[0] * cos(az) + e[1] * sin(az) + e[2] * cos(az + az) + e[3] * sin(az + az)) * S(to_rad(1.0));
    out[1] = out[2] = out[3] = out[4] = S(0.0);
  }
};

class AngleScale final : public TableEffect<AngleScale> {
 public:
  static constexpr std::string_view kName = "table.angle-scale";
  AngleScale() : TableEffect({"kappa"}, "ppm", 100) {}
  template <class S>
  void equation(const Conditions&, int, std::span<const S> in, std::span<const S> c, std::span<S> out) const {
    out[0] = c[0] * in[0] * S(1e-6);
    out[1] = out[2] = out[3] = out[4] = S(0.0);
  }
};

class Backlash final : public TableEffect<Backlash> {
 public:
  static constexpr std::string_view kName = "table.backlash";
  Backlash() : TableEffect({"beta"}, "deg", 0.02) {}
  [[nodiscard]] std::string_view missing(const Pose& pose) const override {
    const std::string_view angle = missing_angle(pose);
    return !angle.empty() ? angle : pose.sense ? "" : "sense";
  }
  /// A few poses without sense (the first of a run was approached from nowhere) count as midway between the
  /// two: their azimuth is off by beta, which is what the uncertainty of the table's angles is for.
  [[nodiscard]] Result<void> applicable(const PoseTable& table) const override;
  template <class S>
  void equation(const Conditions& at, int, std::span<const S>, std::span<const S> c, std::span<S> out) const {
    out[0] = c[0] * S(to_rad(*at.pose.sense));
    out[1] = out[2] = out[3] = out[4] = S(0.0);
  }
};

class Wobble final : public TableEffect<Wobble> {
 public:
  static constexpr std::string_view kName = "table.wobble";
  Wobble() : TableEffect({"w1", "w2"}, "deg", 0.02) {}
  template <class S>
  void equation(const Conditions&, int, std::span<const S> in, std::span<const S> w, std::span<S> out) const {
    using std::cos, std::sin;
    const S c = cos(in[0]) * S(to_rad(1.0)), s = sin(in[0]) * S(to_rad(1.0));
    out[0] = out[1] = out[2] = S(0.0);
    out[3] = w[0] * c + w[1] * s;
    out[4] = w[1] * c - w[0] * s;
  }
};

}  // namespace mgtd::calib::effects::laws
