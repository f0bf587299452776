// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/effects/effect.h"

/// SiteEffect is the base of the effects of the site and of the scalar reference: they have coefficients of
/// the whole array, and they need the attitude.
namespace mgtd::calib::effects::laws {

template <class Self>
class SiteEffect : public EffectOf<Self> {
 public:
  [[nodiscard]] std::string_view name() const override { return Self::kName; }
  [[nodiscard]] Level level() const override { return Level::site; }
  [[nodiscard]] const std::vector<Coefficient>& coefficients() const override { return coefficients_; }
  [[nodiscard]] std::span<const int> at(int) const override { return all_; }
  [[nodiscard]] std::string_view missing(const Pose& pose) const override { return missing_angle(pose); }

 protected:
  void add(std::string coefficient, const char* unit, double typical, double prior_sd = 0) {
    all_.push_back(static_cast<int>(coefficients_.size()));
    coefficients_.push_back(
        {.name = std::move(coefficient), .unit = unit, .typical = typical, .prior_sd = prior_sd});
  }

 private:
  std::vector<Coefficient> coefficients_;
  std::vector<int> all_;
};

}  // namespace mgtd::calib::effects::laws
