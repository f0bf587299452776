// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <numbers>

#include "calib/effects/effect_spec.h"
#include "calib/effects/laws/site_effect.h"
#include "calib/effects/laws/site_gradient.h"
#include "calib/poses/run_time.h"

/// These effects let the field of the site, or its gradient, change with time.
///
///     site.field-drift     B += sum_k c_k cos(k pi t/D), k = 1 .. 3, D the length of the run      nT, 9
///     site.gradient-drift  G += G' (t - t0)                      nT/m/h, 5
///                          G += dG [t >= ts]   (with ts)         nT/m, 5
///
/// With a scalar reference the part of field-drift along the field is measured pose by pose and has nothing
/// left to tell; a prior of 200 nT on each coefficient holds it.
namespace mgtd::calib::effects::laws {

class FieldDrift final : public SiteEffect<FieldDrift> {
 public:
  static constexpr std::string_view kName = "site.field-drift";
  static constexpr int kTerms = 3;
  /// Not given: of the run it is bound to.
  explicit FieldDrift(std::optional<double> hours);
  [[nodiscard]] std::string spec() const override;
  [[nodiscard]] Result<std::shared_ptr<const Effect>> bound(const EffectContext& context) const override;
  [[nodiscard]] std::string_view missing(const Pose& pose) const override {
    const auto angle = missing_angle(pose);
    return angle.empty() ? poses::missing_time(pose) : angle;
  }

  template <class S>
  void equation(const Conditions& at, int, std::span<const S>, std::span<const S> c, std::span<S> out) const {
    out[0] = out[1] = out[2] = S(0.0);
    for (std::size_t k = 0; k < kTerms; ++k) {
      const S phi(std::cos((static_cast<double>(k) + 1) * std::numbers::pi * at.t_h / hours_.value_or(1)));
      for (std::size_t i = 0; i < 3; ++i) out[i] += c[3 * k + i] * phi;
    }
  }

 private:
  std::optional<double> hours_;
};

class GradientDrift final : public SiteEffect<GradientDrift> {
 public:
  static constexpr std::string_view kName = "site.gradient-drift";
  /// With a time: a step there.
  explicit GradientDrift(std::optional<double> ts_h);
  [[nodiscard]] std::string spec() const override;
  [[nodiscard]] std::string_view missing(const Pose& pose) const override {
    const auto angle = missing_angle(pose);
    return angle.empty() ? poses::missing_time(pose) : angle;
  }

  template <class S>
  void equation(const Conditions& at, int, std::span<const S> x, std::span<const S> g,
                std::span<S> out) const {
    const S part(!ts_h_ ? at.t_h : at.t_h >= *ts_h_ ? 1.0 : 0.0);
    gradient_times(g, x, out);
    for (S& component : out) component *= part;
  }

 private:
  std::optional<double> ts_h_;
};

}  // namespace mgtd::calib::effects::laws
