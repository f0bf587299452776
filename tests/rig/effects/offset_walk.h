// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <utility>
#include <vector>

#include "tests/rig/effect.h"
#include "tests/rig/scenario.h"

namespace mgtd::rig {

/// This offset walks at random: independent steps every ten seconds, sd q sqrt(t) after t hours.
class OffsetWalk final : public EffectOf<OffsetWalk> {
 public:
  OffsetWalk(Where where, double nT_per_sqrt_h) : where_(std::move(where)), nT_per_sqrt_h_(nT_per_sqrt_h) {}
  void begin(const Scenario& scenario) override {
    random_.seed(scenario.seed ^ 0x51ed270b0a1f39c1U);
    axes_ = 3 * scenario.truth.size();
  }
  [[nodiscard]] double axis_nT(const AxisContext& c) const override {
    if (!where_.covers(c) || c.t_s < 0) return 0;
    const auto step = static_cast<std::size_t>(c.t_s / kStep_s);
    while (path_.size() <= step + 1) path_.push_back(next());
    const double share = c.t_s / kStep_s - static_cast<double>(step);
    const auto at = static_cast<std::size_t>(3 * c.sensor + c.axis);
    return (1 - share) * path_[step].at(at) + share * path_[step + 1].at(at);
  }
  [[nodiscard]] nlohmann::json truth() const override {
    return {{"effect", "hidden.offset-walk"}, {"where", where_.text()}, {"nT_per_sqrt_h", nT_per_sqrt_h_}};
  }

 private:
  static constexpr double kStep_s = 10;
  using Axes = std::vector<double>;
  [[nodiscard]] Axes next() const {
    if (path_.empty()) return Axes(axes_);
    Axes out = path_.back();
    std::normal_distribution<double> normal(0, nT_per_sqrt_h_ * std::sqrt(kStep_s / 3600));
    for (double& offset : out) offset += normal(random_);
    return out;
  }

  Where where_;
  double nT_per_sqrt_h_;
  std::size_t axes_{3 * kCross};
  mutable std::mt19937_64 random_;
  mutable std::vector<Axes> path_;  ///< grows as far as it is asked for
};

}  // namespace mgtd::rig
