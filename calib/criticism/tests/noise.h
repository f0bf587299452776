// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>

#include "calib/criticism/tests/score.h"
#include "calib/fit/joint/reference_scatter.h"
#include "calib/fit/joint/wandering_estimate.h"

/// A NoiseModel says what the noise is, before anything is said about the model.
///
/// Residuals of pose k with its nuisances fitted are e_k = M_k n_k, M_k = I - N (N'N + Lambda)^-1 N'. They
/// give
///     correlation from pose to pose   rho_c = sum e_kc e_(k-1)c / sum (M_k M_(k-1)')_cc, corrected for what
///                                     the fit took; the median over the channels counts, so that an
///                                     effect on one axis is not taken for noise
///     pure error                      pairs of visits to one attitude: |e_u - e_v|^2 against tr M_u M_u' +
///                                     tr M_v M_v', both in nT where the two weigh differently, so that what
///                                     the model misses at that attitude drops out: eight combinations a pair
///                                     that neither attitude nor field strength moves
namespace mgtd::calib::criticism::tests {

/// Autocorrelation from pose to pose above which noise is not what a dwell shows of it.
inline constexpr double kCorrelated = 0.2;

struct PureError {
  int pairs{0};
  double nu{0};             ///< degrees of freedom
  double ratio{1};          ///< variance between visits over the variance that a pose mean is said to have
  double F{1}, log10_p{0};  ///< lack of fit: the remaining residual against it
  double model_nT{0};       ///< rms that the model misses, beyond the noise

  /// Whether the revisits scatter as much as the whole residual: then the model misses nothing.
  [[nodiscard]] bool accounts_for_residual() const { return log10_p >= -3; }
};

struct NoiseModel {
  double rho{0};
  std::optional<PureError> revisits{};
  NoiseReference reference;
  bool known{true};  ///< the noise of a pose mean, from the spreads within the dwells
  /// Residual over the noise that the dwells tell, where it is larger and no law, no map and no revisit says
  /// that the model is at fault; else one.
  double beyond_dwells{1};
  std::optional<fit::joint::ReferenceScatter>
      vector{};                               ///< of a vector reference, where beyond_dwells counts
  double quantisation_nT{0};                  ///< step of the digitiser, where readings stand on its grid
  fit::joint::WanderingEstimate wandering{};  ///< of the offsets, where the tests stand against it

  [[nodiscard]] bool correlated() const { return rho > kCorrelated; }
};

/// With a margin for its own uncertainty where it counts.
[[nodiscard]] double pose_correlation(const fit::joint::JointProblem& problem,
                                      const fit::joint::JointState& state);
/// Empty without revisits.
[[nodiscard]] std::optional<PureError> pure_error(const fit::joint::JointFit& fit, double chi2, double dof);
/// `residual` at the rho that is in force.
[[nodiscard]] NoiseModel noise_model(const fit::joint::JointFit& fit, const Residual& residual);

}  // namespace mgtd::calib::criticism::tests
