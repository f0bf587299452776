// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/effects/effect.h"
#include "calib/effects/laws/platform_effect.h"

/// `platform.current` is the field of currents that flow near the array and turn with it.
///
///     b_i += sum_c s_ic (I_c - mean of I_c in the run)       nT/A, a vector for each sensor and current
///
/// Currents are the columns that end in "_A" (all of the run, or those named: columns=motor_A/pump_A). At
/// most three at once. A current that never changes is absorbed by the offsets and refused.
namespace mgtd::calib::effects::laws {

class PlatformCurrent final : public PlatformEffect<PlatformCurrent> {
 public:
  static constexpr std::string_view kName = "platform.current";
  static constexpr std::size_t kMaxColumns = 3;
  PlatformCurrent(std::vector<std::string> columns, const Where& where);
  [[nodiscard]] std::string spec() const override;
  [[nodiscard]] Result<std::shared_ptr<const Effect>> bound(const EffectContext& context) const override;
  [[nodiscard]] std::string_view missing(const Pose& pose) const override;
  [[nodiscard]] Result<void> applicable(const PoseTable& table) const override;

  template <class S>
  void equation(const Conditions& at, int, std::span<const S>, std::span<const S> c, std::span<S> out) const {
    out[0] = out[1] = out[2] = S(0.0);
    for (std::size_t k = 0; 3 * k < c.size(); ++k) {
      const S current(above_mean_A(at, columns_[k]));
      for (std::size_t i = 0; i < 3; ++i) out[i] += c[3 * k + i] * current;
    }
  }

 private:
  [[nodiscard]] static double above_mean_A(const Conditions& at, const std::string& column);

  std::vector<std::string> columns_;
};

/// Names of the covariates that end in "_A", over all poses, sorted.
[[nodiscard]] std::vector<std::string> current_columns(const PoseTable& table);

}  // namespace mgtd::calib::effects::laws
