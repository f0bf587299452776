// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <string>

#include "calib/effects/effect_spec.h"
#include "calib/effects/laws/axis_scale.h"
#include "calib/poses/run_time.h"

/// An AxisEffect is an effect of the electronics or the core of an axis, linear in its coefficients:
///
///     y_a += sum_j c_j shape_j(v)        v = readings of the sensor's three axes at nominal scale, nT
///
/// A law gives the shapes; this class lays them over the axes. A law has
///     static constexpr std::string_view kName;
///     static constexpr int kPerAxis;
///     AxisCoefficients coefficients() const;
///     std::string_view missing(const Pose&, int sensor) const;
///     void parameters(EffectSpec&) const;            fixed numbers of the law, for its text
///     template <class S>
///     S shape(const Conditions&, int sensor, int axis, std::span<const S> v, int j) const;
/// and, where it needs the run, Result<Law> on_run(const EffectContext&) const; where it has a memory,
/// std::pair<Law, std::shared_ptr<LiveMemory>> live() const, and where that memory is of a table that was not
/// read, double shape_sd_per_rad(const Conditions&, int sensor, int axis) const for a single shape.
namespace mgtd::calib::effects::laws {

template <class Law>
class AxisEffect final : public EffectOf<AxisEffect<Law>> {
 public:
  AxisEffect(Law law, const Where& where)
      : law_(std::move(law)), where_(where), scale_(law_.coefficients(), where) {}

  [[nodiscard]] std::string_view name() const override { return Law::kName; }
  [[nodiscard]] Level level() const override { return Level::axis; }
  [[nodiscard]] const std::vector<Coefficient>& coefficients() const override {
    return scale_.coefficients();
  }
  [[nodiscard]] std::span<const int> at(int sensor) const override { return scale_.at(sensor); }

  [[nodiscard]] std::string spec() const override {
    EffectSpec out{.name = std::string(name()), .where = where_, .parameters = {}};
    law_.parameters(out);
    return out.text();
  }

  [[nodiscard]] std::string_view missing(const Pose& pose) const override {
    for (int sensor = 0; sensor < scale_.sensors(); ++sensor) {
      if (!scale_.acts_on(sensor)) continue;
      if (const std::string_view column = law_.missing(pose, sensor); !column.empty()) return column;
    }
    return {};
  }

  [[nodiscard]] Result<std::shared_ptr<const Effect>> bound(const EffectContext& context) const override {
    if constexpr (requires { law_.on_run(context); }) {
      auto law = law_.on_run(context);
      if (!law) return tl::unexpected(law.error());
      return std::make_shared<const AxisEffect>(std::move(*law), where_);
    } else {
      return std::shared_ptr<const Effect>();
    }
  }

  [[nodiscard]] LiveEffect live() const override {
    if constexpr (requires { law_.live(); }) {
      auto [law, memory] = law_.live();
      return {std::make_shared<const AxisEffect>(std::move(law), where_), std::move(memory)};
    } else {
      return {};
    }
  }

  [[nodiscard]] double sd_nT_per_rad(const Conditions& at, int sensor, int axis,
                                     std::span<const double> c) const override {
    if constexpr (requires { law_.shape_sd_per_rad(at, sensor, axis); }) {
      static_assert(Law::kPerAxis == 1);
      const int first = scale_.first(sensor, axis);
      if (first < 0) return 0;
      return std::abs(c[static_cast<std::size_t>(first)]) * law_.shape_sd_per_rad(at, sensor, axis);
    } else {
      return 0;
    }
  }

  [[nodiscard]] bool shapes(const Conditions& at, int sensor, std::span<const double> v,
                            std::span<double> out) const override {
    std::fill(out.begin(), out.end(), 0.0);
    for (int axis = 0; axis < 3; ++axis) {
      const int first = scale_.first(sensor, axis);
      for (int j = 0; first >= 0 && j < Law::kPerAxis; ++j)
        out[static_cast<std::size_t>(axis + 3 * (first + j))] =
            law_.template shape<double>(at, sensor, axis, v, j);
    }
    return true;
  }

  template <class S>
  void equation(const Conditions& at, int sensor, std::span<const S> v, std::span<const S> c,
                std::span<S> out) const {
    for (int axis = 0; axis < 3; ++axis) {
      S& y = out[static_cast<std::size_t>(axis)];
      const int first = scale_.first(sensor, axis);
      if (first < 0) {
        y = S(0.0);
        continue;
      }
      y = c[static_cast<std::size_t>(first)] * law_.template shape<S>(at, sensor, axis, v, 0);
      for (int j = 1; j < Law::kPerAxis; ++j)
        y += c[static_cast<std::size_t>(first + j)] * law_.template shape<S>(at, sensor, axis, v, j);
    }
  }

 private:
  Law law_;
  Where where_;
  AxisScale scale_;
};

/// What most laws say of themselves: one coefficient an axis, no numbers of their own, and nothing they need
/// of a pose. A law that differs in one of these says that one.
struct PlainLaw {
  static constexpr int kPerAxis = 1;
  static std::string_view missing(const Pose&, int) { return {}; }
  static void parameters(EffectSpec&) {}
};

/// One coefficient an axis, called after the axis.
[[nodiscard]] inline AxisCoefficients one_per_axis(std::string unit, double typical) {
  return {.suffix = {{{""}, {""}, {""}}}, .unit = std::move(unit), .typical = typical};
}

/// "s3_T_degC" for a pose that lacks this sensor's temperature, else empty.
[[nodiscard]] std::string_view missing_temperature(const Pose& pose, int sensor);
/// A law that reads the temperature of its sensor.
struct TemperatureLaw : PlainLaw {
  static std::string_view missing(const Pose& pose, int sensor) { return missing_temperature(pose, sensor); }
};
/// A law that reads the time.
struct TimeLaw : PlainLaw {
  static std::string_view missing(const Pose& pose, int) { return poses::missing_time(pose); }
};
/// Of the sensor less T0; the pose has it.
[[nodiscard]] inline double warmer_degC(const Conditions& at, int sensor) {
  return *at.pose.T_degC[static_cast<std::size_t>(sensor)] - kReferenceT_degC;
}

}  // namespace mgtd::calib::effects::laws
