// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "calib/criticism/tests/candidate_effect.h"
#include "calib/criticism/tests/multiplicity.h"
#include "calib/criticism/tests/noise.h"
#include "calib/criticism/tests/residual_maps.h"
#include "calib/fit/joint/joint_fit.h"

/// Criticism holds the results of all tests of all tiers on the residual of one fit.
namespace mgtd::calib::criticism::tests {

/// Shares of the chance of a false alarm, 1 % in all.
inline constexpr double kNamedAlarm = 0.0065, kMapAlarm = 0.0025, kOmnibusAlarm = 0.0010;

struct Criticism {
  NoiseModel noise{};
  double chi2{0}, dof{0};
  std::vector<Untestable> untestable{};
  std::vector<ScoredFamily> families{};  ///< testable, best first
  Rates rates{};                         ///< of the families, by draws
  std::vector<MapScore> maps{};
  double omnibus_log10_p{0};  ///< residual larger than its noise; 0 where the noise is the residual's own
  /// The channel that scatters least for its noise, "s3.z", and the probability of so little, all counted.
  std::string low_scatter{};
  double low_scatter_log10_p{0}, low_scatter_ratio{1};
  Residual residual{};                                   ///< in units of the noise
  std::shared_ptr<const fit::joint::JointFit> tested{};  ///< the fit, with the weights of the tests

  /// Evidence for one of the families, pose by pose.
  [[nodiscard]] std::vector<double> evidence_by_pose(std::size_t family) const;
  [[nodiscard]] bool rejects_named(std::size_t family = 0) const;
  /// Whether the winning question of a family would be a name with a score of S.
  [[nodiscard]] bool would_name(std::size_t family, double S) const;
  [[nodiscard]] bool rejects_map() const;
  [[nodiscard]] bool rejects_omnibus() const;
  [[nodiscard]] bool rejects() const { return rejects_named() || rejects_map() || rejects_omnibus(); }
};

/// `candidate_effects` must outlive the result. `before`: rates of a narrower model of the same run, which
/// serve where no p-value is close to its alarm.
[[nodiscard]] Criticism criticise(const fit::joint::JointFit& fit, const CandidateEffects& candidate_effects,
                                  std::uint64_t seed, const Rates* before = nullptr);
/// Against offsets that wander at these rates, in nT per root hour where the white noise is that of the
/// weights. Nothing wanders in `fit` itself.
[[nodiscard]] Criticism criticise_against_walk(const fit::joint::JointFit& fit,
                                               const fit::joint::WanderingRates& nT_per_sqrt_h,
                                               const CandidateEffects& candidate_effects, std::uint64_t seed,
                                               const Rates* before);
/// Chi-square of readings, scalar reference and table angles: readings in units of the noise that the pose
/// table states, angles in units of `table_sd_rad`, which is held: each fit estimates it anew, and that would
/// hide what an effect of the table explains.
[[nodiscard]] double chi2_at_stated_noise(const fit::joint::JointFit& fit, const Criticism& c,
                                          double table_sd_rad);
/// The generic maps, which cost as much as everything else: computed only where no named effect stands out.
void look_at_maps(Criticism& criticism);

}  // namespace mgtd::calib::criticism::tests
