// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>

#include "calib/effects/effect_spec.h"
#include "calib/effects/laws/dipole_field.h"
#include "calib/effects/laws/site_effect.h"

/// `site.step` is the change of the field when something magnetic came to the site or left it, seen by all
/// sensors from one moment on.
///
///     B(x) += dB + dG x         [t >= ts]    dG symmetric and traceless
///     B(x) += D(x - place - shift) [t >= ts]    (with x, y, z: a dipole, see dipole_field.h)
///
/// Site frame; ts in hours since the start of the run. The first form is what any source far from the array
/// does to first order, the second a magnet put down beside it, whose gradient changes over the cross.
///
/// Every pose has a field strength of its own where a scalar reference follows it, so the part of dB along
/// the field is absorbed there and only the change of direction is determined; a prior of 1000 nT holds what
/// is absorbed. A source that leaves again before the run ends is no step.
namespace mgtd::calib::effects::laws {

class SiteStep final : public SiteEffect<SiteStep> {
 public:
  static constexpr std::string_view kName = "site.step";
  /// Not given: the middle of the run it is bound to.
  explicit SiteStep(std::optional<double> ts_h);
  [[nodiscard]] std::string spec() const override;
  [[nodiscard]] Result<std::shared_ptr<const Effect>> bound(const EffectContext& context) const override;
  [[nodiscard]] std::string_view missing(const Pose& pose) const override;

  template <class S>
  void equation(const Conditions& at, int, std::span<const S> x, std::span<const S> c,
                std::span<S> out) const {
    const S on(at.t_h >= ts_h_.value_or(0) ? 1.0 : 0.0);
    const std::span<const S> g = c.subspan(3);
    out[0] = on * (c[0] + g[0] * x[0] + g[2] * x[1] + g[3] * x[2]);
    out[1] = on * (c[1] + g[2] * x[0] + g[1] * x[1] + g[4] * x[2]);
    out[2] = on * (c[2] + g[3] * x[0] + g[4] * x[1] - (g[0] + g[1]) * x[2]);
  }

 private:
  std::optional<double> ts_h_;
};

class SiteStepDipole final : public SiteEffect<SiteStepDipole> {
 public:
  static constexpr std::string_view kName = SiteStep::kName;
  SiteStepDipole(double ts_h, const Eigen::Vector3d& place_S_m);
  [[nodiscard]] std::string spec() const override;
  [[nodiscard]] std::string_view missing(const Pose& pose) const override;

  template <class S>
  void equation(const Conditions& at, int, std::span<const S> x, std::span<const S> c,
                std::span<S> out) const {
    if (at.t_h < ts_h_) {
      out[0] = out[1] = out[2] = S(0.0);
      return;
    }
    std::array<S, 3> d;
    for (std::size_t i = 0; i < 3; ++i) d[i] = x[i] - c[3 + i] - S(start_S_m_[static_cast<Eigen::Index>(i)]);
    const std::array<S, 3> b = dipole_field_nT(c, d);
    for (std::size_t i = 0; i < 3; ++i) out[i] = b[i];
  }

 private:
  double ts_h_;
  Eigen::Vector3d start_S_m_;
};

}  // namespace mgtd::calib::effects::laws
