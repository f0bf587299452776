// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/effects/effect.h"
#include "calib/effects/laws/platform_effect.h"

/// The twelve parameters of a sensor absorb these effects of the platform whole in a uniform field. They are
/// here so that this can be shown; a fit with one of them is refused with the reason.
///
///     platform.hard-iron   b_i += h_i                        nT        part of the offsets
///     platform.soft-iron   b_i += 1e-6 K_i b_i               ppm       part of the matrices
///     platform.crosstalk   b_i += sum_j D_ij kappa_j b_i     cm^3      part of the matrices
///
/// with D_ij = (3 n n' - 1)/r^3, and b_j = b_i as far as the field is uniform.
namespace mgtd::calib::effects::library {

/// Refuses, whatever the poses.
[[nodiscard]] Result<void> absorbed(std::string_view name);

class HardIron final : public laws::PlatformEffect<HardIron> {
 public:
  static constexpr std::string_view kName = "platform.hard-iron";
  HardIron() : PlatformEffect({{"x", "y", "z"}, "nT", 100, {.scale = Where::Scale::own}}) {}
  [[nodiscard]] std::string_view missing(const Pose&) const override { return {}; }
  [[nodiscard]] Result<void> applicable(const PoseTable&) const override { return absorbed(name()); }
  template <class S>
  void equation(const Conditions&, int, std::span<const S>, std::span<const S> h, std::span<S> out) const {
    for (std::size_t i = 0; i < 3; ++i) out[i] = h[i];
  }
};

class SoftIron final : public laws::PlatformEffect<SoftIron> {
 public:
  static constexpr std::string_view kName = "platform.soft-iron";
  SoftIron()
      : PlatformEffect({{"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"},
                        "ppm",
                        1000,
                        {.scale = Where::Scale::own}}) {}
  [[nodiscard]] std::string_view missing(const Pose&) const override { return {}; }
  [[nodiscard]] Result<void> applicable(const PoseTable&) const override { return absorbed(name()); }
  template <class S>
  void equation(const Conditions&, int, std::span<const S> in, std::span<const S> k, std::span<S> out) const {
    for (std::size_t i = 0; i < 3; ++i)
      out[i] = (k[3 * i] * in[0] + k[3 * i + 1] * in[1] + k[3 * i + 2] * in[2]) * S(1e-6);
  }
};

class Crosstalk final : public EffectOf<Crosstalk> {
 public:
  explicit Crosstalk(double baseline_m);
  [[nodiscard]] std::string_view name() const override { return "platform.crosstalk"; }
  [[nodiscard]] std::string spec() const override;
  [[nodiscard]] Level level() const override { return Level::platform; }
  [[nodiscard]] const std::vector<Coefficient>& coefficients() const override { return coefficients_; }
  [[nodiscard]] std::span<const int> at(int) const override { return {all_.data(), all_.size()}; }
  [[nodiscard]] std::string_view missing(const Pose&) const override { return {}; }
  [[nodiscard]] Result<void> applicable(const PoseTable&) const override { return absorbed(name()); }
  template <class S>
  void equation(const Conditions&, int sensor, std::span<const S> in, std::span<const S> k,
                std::span<S> out) const {
    for (std::size_t i = 0; i < 3; ++i) {
      out[i] = S(0.0);
      for (std::size_t j = 0; j < kSensors; ++j) {
        const Eigen::Matrix3d& D = coupling_[static_cast<std::size_t>(sensor)][j];
        const auto row = static_cast<Eigen::Index>(i);
        out[i] += k[j] * (in[0] * S(D(row, 0)) + in[1] * S(D(row, 1)) + in[2] * S(D(row, 2)));
      }
    }
  }

 private:
  double baseline_m_;
  std::vector<Coefficient> coefficients_;
  PerSensor<int> all_{0, 1, 2, 3};
  PerSensor<PerSensor<Eigen::Matrix3d>> coupling_;  ///< per cm^3
};

}  // namespace mgtd::calib::effects::library
