// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/conclusion.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <variant>

#include "calib/criticism/search/temperature_dependence.h"
#include "calib/criticism/tests/local_lack_of_fit.h"
#include "calib/criticism/tests/multiplicity.h"
#include "calib/effects/common_axis.h"
#include "calib/fit/checks/check_limits.h"
#include "calib/fit/joint/agreement.h"
#include "calib/fit/joint/single_samples.h"

namespace mgtd::calib::criticism::search {
namespace {

/// Of an excess of four of its own standard deviations or more: by chance a right law falls below this in one
/// run of a hundred, and below 0.8 in one of seven.
constexpr double kEnoughShare = 0.5;
constexpr double kTooLittleScatter = 0.6;  ///< of the stated noise; heavy tails alone may leave 0.65
constexpr double kTooSmall = 0.0005;       ///< chance of a residual so small
constexpr double kRefit = 0.2;             ///< predicted and realised fall may differ by this

/// Poses with an observation that is left out, of all poses. Where a law accounts for them, explain() has
/// taken them back.
double contradicted(const fit::joint::JointFit& fit) {
  std::set<int> poses;
  for (const fit::OutlierNode& node : fit.outliers) poses.insert(node.pose);
  return static_cast<double>(poses.size()) / static_cast<double>(fit.problem.poses.size());
}

/// Why a single name that accounts for the data is not yet an explanation; nothing when it is.
std::optional<ExplainNote> doubt(const Round& round, const Asked& before) {
  const tests::Candidate& a = round.added;
  const double spread = 4 * std::sqrt(2 * before.dof);
  if (before.reference.from_dwells() && before.reference.chi2 - before.dof > spread && a.share < kEnoughShare)
    return ExcessRemains{a.effect, a.share};
  const double realised = round.chi2_before - round.chi2_after;
  if (before.reference.known && std::abs(realised - a.fall) > kRefit * a.fall + 3 * std::sqrt(2 * a.fall))
    return FallNotAsPredicted{realised, a.fall};
  return std::nullopt;
}

/// Of the named laws the one that leaves most on its own axes, in relation to chance; nothing where each of
/// them leaves no more than chance does among so many.
std::optional<ExplainNote> lack_of_fit_that_remains(const ExplainReport& report,
                                                    const tests::Criticism& last) {
  LackOfFitRemains most;
  std::set<std::string> places;
  for (const Round& round : report.rounds) {
    for (const effects::EffectPtr& effect : round.effects) {
      const auto spec = effects::EffectSpec::parse(effect->spec());
      const std::string where = spec && spec->where ? spec->where->text() : round.added.where;
      if (places.contains(where)) continue;
      const double log10_p = tests::local_lack_of_fit_log10_p(last, where);
      if (log10_p < 0) places.insert(where);
      if (log10_p < most.log10_p) most = {round.added.effect, where, log10_p};
    }
  }
  if (places.empty()) return std::nullopt;
  most.log10_p = tests::best_of(most.log10_p, static_cast<double>(places.size()));
  if (most.log10_p < std::log10(tests::kLackOfFitAlarm)) return most;
  return std::nullopt;
}

std::set<std::string> names_of(const std::vector<Round>& rounds) {
  std::set<std::string> out;
  for (const Round& round : rounds) out.insert(round.added.effect);
  return out;
}

/// What a round took away, in standard deviations of the noise of the dwells, where that is all that is left.
/// When it was tested it was measured by all that the rounds after it took away.
double fall_at_the_end(const Round& round, const tests::Criticism& last) {
  if (!last.noise.reference.from_dwells()) return 0;
  return std::sqrt(std::max(0.0, round.chi2_before - round.chi2_after - round.added.k));
}

/// Of several names that together leave only noise, one that itself is little more than that; empty when all
/// stand out.
std::optional<ExplainNote> weak_name(const std::vector<Round>& rounds, const tests::Criticism& last) {
  constexpr double kSigmas = 8;     // from here on the right law of the library stands first, and alone
  constexpr double kDecisive = 30;  // that a term of a law that stands out took away
  for (const Round& round : rounds) {
    const bool stands_out =
        round.added.d >= kSigmas || (added_term_of_dependence(rounds, round.added.effect, kSigmas) &&
                                     fall_at_the_end(round, last) >= kDecisive);
    if (!stands_out) return SizeTooSmall{round.added.effect, round.added.d};
  }
  return std::nullopt;
}

/// One law on one axis with two values of its searched number.
bool several_steps(const std::vector<Round>& rounds) {
  std::vector<effects::EffectPtr> seen;
  for (const Round& round : rounds) {
    for (const effects::EffectPtr& effect : round.effects) {
      const auto spec = effects::EffectSpec::parse(effect->spec());
      if (!spec) return true;
      for (const effects::EffectPtr& earlier : seen) {
        const auto other = effects::EffectSpec::parse(earlier->spec());
        if (effects::same_law_on_a_common_axis(*effect, *earlier) && spec->parameters != other->parameters)
          return true;
      }
      seen.push_back(effect);
    }
  }
  return false;
}

/// Nothing but steps was found, and what is left still follows time.
bool steps_of_a_curve(const ExplainReport& report, const tests::Criticism& last) {
  const std::set<std::string> names = names_of(report.rounds);
  const auto is_step = [](const std::string& name) { return name.ends_with(".step"); };
  return std::all_of(names.begin(), names.end(), is_step) && !last.maps.empty() &&
         (last.maps.front().map == "time" || last.maps.front().map == "own reading x time");
}

/// Wiring and bookkeeping that no effect stands for; empty when there is none to be seen.
std::optional<ExplainNote> wrong_wiring(const fit::joint::JointFit& fit, double table_sd_rad) {
  std::vector<std::size_t> mirrored;
  for (std::size_t i = 0; i < fit.state.sensors.size(); ++i)
    if (fit.state.sensors[i].mounting.determinant() < 0) mirrored.push_back(i + 1);
  if (!mirrored.empty()) return SensorsMirrored{fit.state.sensors.size(), std::move(mirrored)};
  const double limit = fit::checks::table_limit_rad(table_sd_rad);
  if (fit.table_sd_rad > limit) return TableAnglesContradict{fit.table_sd_rad, limit};
  return std::nullopt;
}

/// A residual far above the noise that is not a law's: the poses contradict each other, and it has longer
/// tails than any law leaves or no shape at all; or, where no name stays, a few readings make it. Empty when
/// it is not so.
std::optional<ExplainNote> residual_without_law(const fit::joint::JointFit& fit, const tests::Criticism& last,
                                                bool named) {
  if (!(fit.noise_inflation > 1) || last.noise.wandering.any()) return std::nullopt;
  const fit::joint::Scatter scatter = fit::joint::scatter_of(fit);
  const bool contradicting = fit.contradicting > fit::checks::kMaxBadPoses;
  const bool no_law = scatter.residual_nT > fit::joint::kTailsOfLaw * scatter.typical_nT;
  const bool no_shape = !named && !last.rejects();
  const bool bad = (contradicting && (no_law || no_shape)) || (!named && scatter.few_far_off());
  if (!bad) return std::nullopt;
  return ResidualWithoutLaw{fit.noise_inflation, scatter.residual_nT, scatter.typical_nT, fit.contradicting};
}

}  // namespace

bool stays_far_above_noise(const ExplainReport& report, const tests::Criticism& last) {
  const fit::joint::JointFit& fit = report.rounds.empty() ? *report.fit : *report.rounds.back().fit;
  const bool by_revisits = last.noise.revisits && last.noise.revisits->accounts_for_residual();
  return report.noise.known && fit.noise_inflation > 1 && !last.noise.wandering.any() && !by_revisits;
}

Finding conclude(const ExplainReport& report, const Asked& first, const tests::Criticism& last,
                 std::vector<ExplainNote>& notes) {
  const fit::joint::JointFit& fit = report.rounds.empty() ? *report.fit : *report.rounds.back().fit;
  if (auto why = residual_without_law(fit, last, !report.rounds.empty())) {
    notes.push_back(*std::move(why));
    return Finding::bad_data;
  }
  const Finding open = report.rounds.empty() ? Finding::unknown : Finding::partial;
  if (last.rejects()) return open;
  if (stays_far_above_noise(report, last)) {
    const double left_nT = report.rounds.empty() ? report.residual_nT : report.rounds.back().rms_after_nT;
    notes.emplace_back(FarAboveNoise{left_nT, report.noise_nT});
    return open;
  }
  if (report.rounds.empty()) return Finding::pass;
  const Round& round = report.rounds.front();
  if (auto remains = lack_of_fit_that_remains(report, last)) {
    notes.push_back(*std::move(remains));
    return Finding::partial;
  }
  if (several_steps(report.rounds)) {
    notes.emplace_back(StepsFollowCurve{});
    return Finding::partial;
  }
  const bool several = names_of(report.rounds).size() > 1;
  const bool ambiguous = std::any_of(report.rounds.begin(), report.rounds.end(),
                                     [](const Round& r) { return !r.possible.empty(); });
  if (several ? ambiguous : !round.possible.empty()) return Finding::ambiguous;
  auto why = several ? weak_name(report.rounds, last) : doubt(round, first);
  if (!why) return Finding::explained;
  notes.push_back(*std::move(why));
  return Finding::partial;
}

bool bad_data(const fit::joint::JointFit& fit, const tests::Criticism& c, double table_sd_rad,
              std::vector<ExplainNote>& notes) {
  if (auto why = wrong_wiring(fit, table_sd_rad)) {
    notes.push_back(*std::move(why));
    return true;
  }
  if (fit::checks::table_is_rough(fit.table_sd_rad, table_sd_rad))
    notes.emplace_back(TableAnglesRough{fit.table_sd_rad, table_sd_rad});
  if (const double share = contradicted(fit); share > fit::checks::kMaxBadPoses) {
    notes.emplace_back(PosesContradict{share});
    return true;
  }
  if (c.low_scatter_ratio < kTooLittleScatter && c.low_scatter_log10_p < std::log10(kTooSmall)) {
    notes.emplace_back(NoiseOverstated{c.low_scatter, c.low_scatter_ratio});
    return true;
  }
  return false;
}

bool take_back_what_describes_a_recording(ExplainReport& report, const tests::Criticism& last) {
  constexpr double kHalf = 0.5;
  if (report.rounds.empty() || report.noise.known || !fit::joint::is_recording(report.fit->problem))
    return false;
  const double before_nT = report.rounds.front().rms_before_nT, after_nT = report.rounds.back().rms_after_nT;
  const bool lesser_part = last.rejects() && after_nT * after_nT >= kHalf * before_nT * before_nT;
  const bool curve = several_steps(report.rounds) || (last.rejects_map() && steps_of_a_curve(report, last));
  if (!lesser_part && !curve) return false;
  report.notes.emplace_back(DescribesRecording{names_of(report.rounds), before_nT, after_nT, curve});
  report.rounds.clear();
  report.next.clear();
  return true;
}

void share_what_fell(ExplainReport& report) {
  if (report.rounds.empty() || report.noise.reference.from_dwells()) return;
  const double left = std::pow(report.rounds.back().rms_after_nT / report.rounds.front().rms_before_nT, 2);
  const double unit = report.chi2 / report.dof, excess = report.chi2 * (1 - left);
  const auto share = [&](tests::Candidate& c) {
    c.share = excess > 0 ? std::clamp((c.fall - c.k * unit * left) / excess, 0.0, 1.0) : 0;
  };
  for (tests::Candidate& c : report.candidates) share(c);
  share(report.rounds.front().added);
}

}  // namespace mgtd::calib::criticism::search
