// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/run/field_blocks.h"
#include "proto/run_status.h"

/// disturbance_in() tests whether the field changes while the table stands, because something magnetic passes
/// by.
///
///   array    S = sum over A = 3N axes and B blocks of (block - mean)^2 / w,  w = expected variance of a
///   block
///            F = S / (A (B - 1)) / kappa,  kappa the same quotient at rest: preflight and good dwells
///
///   scalar   F = scatter of its readings / that at rest
///
/// Disturbed when F is exceeded by chance with less than `false_alarm` / looks, and the change is above
/// `limit_nT`. What is common to all axes counts once: the degrees of freedom are those of three axes, so
/// that ambient noise, which they share, raises no alarm; where the axes are independent the rate of
/// false alarms is smaller than stated.
namespace mgtd::daemon::run {

struct DisturbanceLimits {
  double limit_nT{0.5};      ///< rms change of the field, below which nothing matters
  double false_alarm{1e-4};  ///< of a dwell, at most, where nothing disturbs
};

/// How much blocks and readings scatter when nothing disturbs.
class FieldNoise {
 public:
  /// One reading of the scalar reference scatters by so much, until readings say otherwise.
  explicit FieldNoise(double scalar_sd_nT);

  void begin(const FieldBlocks& at_rest);
  /// A good dwell. The latest few hundred degrees of freedom count.
  void add(const FieldBlocks& at_rest);
  /// False: too little was seen to judge by.
  [[nodiscard]] bool known() const { return dof_ > 0; }
  /// Of the field's magnitude, one block.
  [[nodiscard]] double block_nT() const;

 private:
  friend struct DisturbanceStatistic;
  FieldBlocks::Axes weight_nT2_;  ///< empty until the field at rest was seen
  double sum_{0}, dof_{0};
  double scalar_sum_nT2_, scalar_dof_;
};

struct FieldDisturbance {
  enum class SeenBy { array, scalar, level };  ///< level: of the scalar reference, against the pose before
  double change_nT{0};                         ///< of the level with its sign
  double limit_nT{0};                          ///< that the change had to exceed to be no noise
  SeenBy seen_by{SeenBy::array};
  double level_nT{0};  ///< that the scalar reference reads, where the level changed
  [[nodiscard]] std::string in_words() const;
};
[[nodiscard]] std::string_view name(FieldDisturbance::SeenBy seen_by);

/// The larger change of the two, with or without significance. Nothing before the noise is known, or while
/// there are fewer than two blocks.
[[nodiscard]] std::optional<FieldChange> change_in(const FieldBlocks& field, const FieldNoise& noise,
                                                   const DisturbanceLimits& limits);

/// `looks`: how often one dwell is judged. Nothing while there are fewer than two blocks.
[[nodiscard]] std::optional<FieldDisturbance> disturbance_in(const FieldBlocks& field,
                                                             const FieldNoise& noise,
                                                             const DisturbanceLimits& limits,
                                                             std::size_t looks);

}  // namespace mgtd::daemon::run
