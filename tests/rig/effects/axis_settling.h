// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "tests/rig/effect.h"

namespace mgtd::rig {

/// This axis creeps after a change: z follows x with time constant tau, y += eta (z - x).
class AxisSettling final : public EffectOf<AxisSettling> {
 public:
  AxisSettling(Where where, double eta_nT, double tau_s)
      : where_(std::move(where)), eta_nT_(eta_nT), tau_s_(tau_s) {}
  [[nodiscard]] bool remembers() const override { return true; }
  void follow(const AxisContext& c) override {
    State& s = state_.at(at(c));
    s.z = s.begun ? c.x() + (s.z - c.x()) * std::exp(-(c.t_s - s.t_s) / tau_s_) : c.x();
    s.t_s = c.t_s;
    s.begun = true;
  }
  [[nodiscard]] double axis_nT(const AxisContext& c) const override {
    return where_.covers(c) ? eta_nT_ * (state_.at(at(c)).z - c.x()) : 0;
  }
  [[nodiscard]] nlohmann::json truth() const override {
    return {{"effect", "axis.settling"}, {"where", where_.text()}, {"eta_nT", eta_nT_}, {"tau_s", tau_s_}};
  }

 private:
  struct State {
    bool begun{false};
    double z{0}, t_s{0};
  };
  static std::size_t at(const AxisContext& c) { return static_cast<std::size_t>(3 * c.sensor + c.axis); }

  Where where_;
  double eta_nT_, tau_s_;
  std::array<State, 3 * kMostPlaces> state_{};
};

}  // namespace mgtd::rig
