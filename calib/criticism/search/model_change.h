// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "calib/criticism/search/model_stage.h"

/// A model change adds one effect to a model, or drops one, fits everything again, and says what that did.
///
///     predicted   of chi-square, from the narrower model alone (score test) when added; from the wider one
///                 alone (Wald test) when dropped
///     realised    the same after the fit, both models under the weights of the first
///
/// The two agree while the effect is small against what it acts on; where they do not, the effect was not
/// what it looked like.
namespace mgtd::calib::criticism::search {

/// The tests that a change failed: not to be made unattended.
enum class Veto {
  held_out,   ///< the error on held-out poses rises
  not_shown,  ///< chance alone brings such a fall in more than one run of twenty; adding only
  price,      ///< a standard deviation of the calibration grows more than a hundredfold; adding only
};
inline constexpr double kVetoChance = 0.05, kVetoPrice = 100;

struct ModelChange {
  bool adding{true};
  std::string effect{};                                        ///< of the family, or a user's name
  std::string spec{};                                          ///< with the numbers that were searched
  std::vector<std::string> model{};                            ///< specs, afterwards
  std::vector<calibration::EffectCoefficient> coefficients{};  ///< of this effect, in the wider model
  int k{0};                                                    ///< coefficients that the poses can tell
  double predicted{0}, realised{0};  ///< fall (adding) or rise (dropping) of chi-square
  double log10_p{0};  ///< that chance alone makes so large a realised one, at the noise of the wider model
  double birge_ratio{1};  ///< of the wider model, where it is significantly above one
  double chi2_before{0}, chi2_after{0}, dof_before{0}, dof_after{0};
  double rms_before_nT{0}, rms_after_nT{0}, noise_nT{0};
  double tensor_before_nT_per_m{0}, tensor_after_nT_per_m{0};
  std::optional<double> held_out_before_nT{}, held_out_after_nT{};
  VariancePrice price{};  ///< of the wider model

  [[nodiscard]] std::vector<Veto> vetoes() const;
  [[nodiscard]] bool vetoed() const { return !vetoes().empty(); }
};

/// `options`: the model as it is. A step of the site without a place becomes the dipole that came, where that
/// leaves clearly less (step_of_a_source.h). Refuses what a fit refuses, and an effect that the model holds
/// already.
[[nodiscard]] Result<ModelChange> add_effect(const PoseTable& table, const fit::FitOptions& options,
                                             const effects::EffectPtr& effect);
/// `which`: its place in options.effects.
[[nodiscard]] Result<ModelChange> drop_effect(const PoseTable& table, const fit::FitOptions& options,
                                              std::size_t which);

}  // namespace mgtd::calib::criticism::search
