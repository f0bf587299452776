// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include "calib/effects/laws/platform_scale.h"

/// PlatformEffect is the base of the effects of the platform, which have a vector or a matrix of coefficients
/// for each sensor.
namespace mgtd::calib::effects::laws {

template <class Self>
class PlatformEffect : public EffectOf<Self> {
 public:
  [[nodiscard]] std::string_view name() const override { return Self::kName; }
  [[nodiscard]] std::string spec() const override { return scale_.spec(name()); }
  [[nodiscard]] Level level() const override { return Level::platform; }
  [[nodiscard]] const std::vector<Coefficient>& coefficients() const override {
    return scale_.coefficients();
  }
  [[nodiscard]] std::span<const int> at(int sensor) const override { return scale_.at(sensor); }

 protected:
  explicit PlatformEffect(PlatformScale scale) : scale_(std::move(scale)) {}
  [[nodiscard]] const PlatformScale& scale() const { return scale_; }

 private:
  PlatformScale scale_;
};

}  // namespace mgtd::calib::effects::laws
