// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "calib/fit/method_choice/fit.h"
#include "calib/validity/change.h"

/// check() tells whether an earlier calibration is still valid, from a dozen poses, which need not determine
/// a calibration of their own.
///
/// The calibration is held and each pose fits its own field. What remains is compared with what the noise
/// of these poses *and* the covariance of the calibration allow: score test of all its parameters together,
/// and of each alone. The attitude of the whole array on its table is free (it may have been mounted again),
/// and so is the site: its field, and the coefficients of effects of the site.
namespace mgtd::calib::validity {

struct ValidityReport {
  std::string calibration;  ///< its id
  int poses{0};
  bool own_poses{false};          ///< those that it was fitted to, which do not test it
  bool valid{false};              ///< no change (kChanged), and the poses follow the model
  Change change;                  ///< new less old, as far as these poses tell it
  fit::ErrorSummary errors;       ///< of the fixed calibration on these poses
  double residual_nT{0};          ///< PoseResiduals::residual_nT, with the calibration fixed
  double noise_nT{0};             ///< of a pose mean, as weighted
  double excess{1};               ///< scatter that no change of the calibration explains, over the noise
  bool noise_from_dwells{false};  ///< else the noise is that of the calibration's own run
  std::vector<fit::OutlierNode> outliers;
  std::optional<CommonTurn> turn;  ///< since the calibration; where a vector reference tells it

  /// Whether a parameter of the calibration changed; a calibration that did not change is still not valid
  /// where the poses scatter too much.
  [[nodiscard]] bool changed() const { return change.p() < kChanged; }
};

/// All poses count, whatever their set. Of `options` the field, the table's uncertainty and further effects
/// of the site are used. Refuses too few poses and effects that need what the poses do not have.
[[nodiscard]] Result<ValidityReport> check(const calibration::Calibration& calibration,
                                           const PoseTable& table, const fit::FitOptions& options);

}  // namespace mgtd::calib::validity
