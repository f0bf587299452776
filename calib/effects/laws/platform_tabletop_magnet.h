// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <vector>

#include "calib/effects/effect.h"

/// `platform.tabletop-magnet` is the field of something magnetic on the table, which turns with it while the
/// array is remounted.
///
///     b_i += M d_i        d_i constant in the table's frame, M the mounting of the array on the table
///
/// The table of poses knows the number of a mounting and not its rotation, so each mounting has a vector M
/// d_i of its own for each sensor; that of the first mounting is part of the offsets: "m2.s3.x" is relative
/// to it.
namespace mgtd::calib::effects::laws {

class TabletopMagnet final : public EffectOf<TabletopMagnet> {
 public:
  /// `mounts` without repetition; empty: those of the run it is bound to.
  TabletopMagnet(std::vector<int> mounts, int sensors);
  [[nodiscard]] std::string_view name() const override { return "platform.tabletop-magnet"; }
  [[nodiscard]] std::string spec() const override;
  [[nodiscard]] Result<std::shared_ptr<const Effect>> bound(const EffectContext& context) const override;
  [[nodiscard]] Level level() const override { return Level::platform; }
  [[nodiscard]] const std::vector<Coefficient>& coefficients() const override { return coefficients_; }
  [[nodiscard]] std::span<const int> at(int sensor) const override;
  [[nodiscard]] std::span<const int> active(const Conditions& at, int sensor) const override;
  [[nodiscard]] std::string_view missing(const Pose& pose) const override {
    return pose.mount ? "" : "mount";
  }

  template <class S>
  void equation(const Conditions&, int, std::span<const S>, std::span<const S> c, std::span<S> out) const {
    for (std::size_t i = 0; i < 3; ++i) out[i] = c.empty() ? S(0.0) : c[i];
  }

 private:
  std::vector<int> mounts_;
  std::vector<Coefficient> coefficients_;
  PerSensor<std::vector<int>> all_;
  PerSensor<std::map<int, std::vector<int>>> of_mount_;
};

}  // namespace mgtd::calib::effects::laws
