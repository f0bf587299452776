// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <optional>

#include "tests/rig/effect.h"

/// Effects of the electronics of one axis, y += ... (T0 = 20 degC, F0 = 50 000 nT, x = v/F0).
namespace mgtd::rig {

/// y += alpha (T - T0)
class OffsetTemperature final : public Effect {
 public:
  OffsetTemperature(Where where, double nT_per_degC) : where_(std::move(where)), nT_per_degC_(nT_per_degC) {}
  double axis_nT(const AxisContext& c) override {
    return where_.covers(c.sensor, c.axis) ? nT_per_degC_ * (c.T_degC - kT0_degC) : 0;
  }
  nlohmann::json truth() const override {
    return {{"effect", "axis.offset.temperature"}, {"where", where_.text()}, {"nT_per_degC", nT_per_degC_}};
  }

 private:
  Where where_;
  double nT_per_degC_;
};

/// y += 1e-6 kappa (T - T0) v
class GainTemperature final : public Effect {
 public:
  GainTemperature(Where where, double ppm_per_degC) : where_(std::move(where)), ppm_per_degC_(ppm_per_degC) {}
  double axis_nT(const AxisContext& c) override {
    return where_.covers(c.sensor, c.axis) ? 1e-6 * ppm_per_degC_ * (c.T_degC - kT0_degC) * c.v_nT[c.axis]
                                           : 0;
  }
  nlohmann::json truth() const override {
    return {{"effect", "axis.gain.temperature"}, {"where", where_.text()}, {"ppm_per_degC", ppm_per_degC_}};
  }

 private:
  Where where_;
  double ppm_per_degC_;
};

/// y += q x^2 (power 2) or c x^3 (power 3), nT at F0
class Nonlinearity final : public Effect {
 public:
  Nonlinearity(Where where, int power, double nT_at_F0)
      : where_(std::move(where)), power_(power), nT_at_F0_(nT_at_F0) {}
  double axis_nT(const AxisContext& c) override {
    return where_.covers(c.sensor, c.axis) ? nT_at_F0_ * std::pow(c.v_nT[c.axis] / kF0_nT, power_) : 0;
  }
  nlohmann::json truth() const override {
    return {{"effect", power_ == 2 ? "axis.quadratic" : "axis.cubic"},
            {"where", where_.text()},
            {"nT_at_F0", nT_at_F0_}};
  }

 private:
  Where where_;
  int power_;
  double nT_at_F0_;
};

/// Play: p <- max(x - w, min(x + w, p)) from p = 0 along the whole path; y += h (p - x)/w.
class Hysteresis final : public Effect {
 public:
  Hysteresis(Where where, double h_nT, double width) : where_(std::move(where)), h_nT_(h_nT), width_(width) {}
  double axis_nT(const AxisContext& c) override {
    if (!where_.covers(c.sensor, c.axis)) return 0;
    double& p = play_.at(static_cast<std::size_t>(3 * c.sensor + c.axis));
    const double x = c.v_nT[c.axis] / kF0_nT;
    p = std::max(x - width_, std::min(x + width_, p));
    return h_nT_ * (p - x) / width_;
  }
  nlohmann::json truth() const override {
    return {{"effect", "axis.hysteresis"}, {"where", where_.text()}, {"h_nT", h_nT_}, {"width", width_}};
  }

 private:
  Where where_;
  double h_nT_, width_;
  std::array<double, 12> play_{};
};

}  // namespace mgtd::rig
