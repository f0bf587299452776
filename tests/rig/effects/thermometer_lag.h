// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "tests/rig/effect.h"

namespace mgtd::rig {

/// The core follows the thermometer with time constant tau: y += alpha (T_core - T0).
class ThermometerLag final : public EffectOf<ThermometerLag> {
 public:
  ThermometerLag(Where where, double nT_per_degC, double tau_s)
      : where_(std::move(where)), nT_per_degC_(nT_per_degC), tau_s_(tau_s) {}
  [[nodiscard]] bool remembers() const override { return true; }
  void follow(const AxisContext& c) override {
    Core& core = core_.at(static_cast<std::size_t>(c.sensor));
    if (!core.begun) core = {true, c.T_degC, c.T_degC, c.t_s};
    const double dt = c.t_s - core.t_s;
    if (dt <= 0) return;
    // The thermometer in between: a straight line.
    const double slope = (c.T_degC - core.shown_degC) / dt, decay = std::exp(-dt / tau_s_);
    const double lag = slope * tau_s_;
    core.T_degC = c.T_degC - lag + (core.T_degC - core.shown_degC + lag) * decay;
    core.shown_degC = c.T_degC;
    core.t_s = c.t_s;
  }
  [[nodiscard]] double axis_nT(const AxisContext& c) const override {
    return where_.covers(c) ? nT_per_degC_ * (core_.at(static_cast<std::size_t>(c.sensor)).T_degC - kT0_degC)
                            : 0;
  }
  [[nodiscard]] nlohmann::json truth() const override {
    return {{"effect", "hidden.thermometer-lag"},
            {"where", where_.text()},
            {"nT_per_degC", nT_per_degC_},
            {"tau_s", tau_s_}};
  }

 private:
  struct Core {
    bool begun{false};
    double T_degC{kT0_degC}, shown_degC{kT0_degC}, t_s{0};
  };
  Where where_;
  double nT_per_degC_, tau_s_;
  std::array<Core, kMostPlaces> core_{};
};

}  // namespace mgtd::rig
