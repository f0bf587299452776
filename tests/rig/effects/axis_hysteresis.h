// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "tests/rig/effect.h"

namespace mgtd::rig {

/// The core of an axis remembers where it came from: the play operator p <- max(x - w, min(x + w, p)),
/// started at 0, along the whole path; y += h (p - x)/w.
class AxisHysteresis final : public EffectOf<AxisHysteresis> {
 public:
  AxisHysteresis(Where where, double h_nT, double width)
      : where_(std::move(where)), h_nT_(h_nT), width_(width) {}
  [[nodiscard]] bool remembers() const override { return true; }
  void follow(const AxisContext& c) override {
    double& p = play_.at(at(c));
    p = std::max(c.x() - width_, std::min(c.x() + width_, p));
  }
  [[nodiscard]] double axis_nT(const AxisContext& c) const override {
    return where_.covers(c) ? h_nT_ * (play_.at(at(c)) - c.x()) / width_ : 0;
  }
  [[nodiscard]] nlohmann::json truth() const override {
    return {{"effect", "axis.hysteresis"}, {"where", where_.text()}, {"h_nT", h_nT_}, {"width", width_}};
  }

 private:
  static std::size_t at(const AxisContext& c) { return static_cast<std::size_t>(3 * c.sensor + c.axis); }

  Where where_;
  double h_nT_, width_;
  std::array<double, 3 * kMostPlaces> play_{};
};

}  // namespace mgtd::rig
