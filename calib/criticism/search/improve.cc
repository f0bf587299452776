// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/improve.h"

#include <memory>

#include "calib/criticism/search/model_stage.h"
#include "calib/criticism/search/prune.h"
#include "calib/effects/added_effects.h"
#include "calib/fit/joint/cross_validation.h"
#include "calib/fit/joint/joint_report.h"
#include "calib/fit/joint/pose_residuals.h"

namespace mgtd::calib::criticism::search {
namespace {

/// The simplified model, where the error on held-out poses does not rise; where that cannot be judged, the
/// residual.
void prune_unless_worse(const PoseTable& table, const fit::FitOptions& options,
                        const fit::joint::JointOptions& joint, const fit::joint::JointFit& last,
                        fit::FitOptions& best) {
  fit::joint::JointOptions tidy = joint;
  tidy.effects = best.effects;
  tidy.noise_inflation = last.noise_inflation;
  fit::joint::JointFit fit = last;
  const std::size_t given =
      best.effects.size() - effects::added_effects(best.effects, options.effects).size();
  prune(table, given, tidy, fit);
  const auto before = fit::joint::left_out_nT(last), after = fit::joint::left_out_nT(fit);
  if (before && (!after || *after > kHeldOutVeto * *before)) return;
  const auto residual_nT = [](const fit::joint::JointFit& f) {
    return fit::joint::pose_residuals(f.problem, f.state).residual_nT();
  };
  if (!before && residual_nT(fit) > kHeldOutVeto * residual_nT(last)) return;
  best.effects = std::move(tidy.effects);
}

/// How many of the first rounds to keep, by the error on poses left out before them and after each: one after
/// which it rises is kept only where a later one lowers it again. The laws of one sensor may only help
/// together.
std::size_t rounds_that_pay(const std::vector<std::optional<double>>& held_out_nT) {
  std::size_t kept = 0;
  for (std::size_t i = 1; i < held_out_nT.size(); ++i) {
    const bool known = held_out_nT[kept] && held_out_nT[i];
    if (!known || *held_out_nT[i] <= kHeldOutVeto * *held_out_nT[kept]) kept = i;
  }
  return kept;
}

ImproveStop stop_of(const ExplainReport& explained) {
  switch (explained.left) {
    case Finding::unknown:
      return ImproveStop::no_effect_looks_like_it;
    case Finding::bad_data:
      return ImproveStop::bad_data;
    case Finding::pass:
      return ImproveStop::nothing_stands_out;
    default:
      return explained.rounds.size() >= kImproveRounds ? ImproveStop::round_limit
                                                       : ImproveStop::nothing_can_be_added;
  }
}

}  // namespace

Result<ImproveReport> improve(const PoseTable& table, const fit::FitOptions& options,
                              const std::vector<tests::CandidateEffect>& also) {
  const auto explained =
      explain(table, {.fit = options, .rounds = static_cast<int>(kImproveRounds), .also = also});
  if (!explained) return tl::unexpected(explained.error());
  ImproveReport out{
      .finding = explained->left, .stopped = stop_of(*explained), .notes = explained->notes, .fit = {}};
  const fit::joint::JointOptions joint = fit::joint::joint_options(options);
  std::shared_ptr<const fit::joint::JointFit> last = explained->fit;
  std::vector<std::optional<double>> held_out_nT{fit::joint::left_out_nT(*last)};
  for (const Round& round : explained->rounds) held_out_nT.push_back(fit::joint::left_out_nT(*round.fit));
  const std::size_t kept = rounds_that_pay(held_out_nT);
  if (kept < explained->rounds.size()) {
    out.stopped = ImproveStop::held_out_error_rises;
    out.refused =
        RefusedEffect{explained->rounds[kept].added.spec, *held_out_nT[kept], *held_out_nT[kept + 1]};
    out.finding = Finding::partial;
  }
  fit::FitOptions best = options;
  for (std::size_t i = 0; i < kept; ++i) {
    const Round& round = explained->rounds[i];
    out.rounds.push_back({.added = round.added,
                          .possible = round.possible,
                          .rms_before_nT = round.rms_before_nT,
                          .rms_after_nT = round.rms_after_nT,
                          .held_out_before_nT = held_out_nT[i],
                          .held_out_after_nT = held_out_nT[i + 1],
                          .predicted_fall = round.added.fall,
                          .realised_fall = round.chi2_before - round.chi2_after,
                          .price = variance_price(*last, *round.fit)});
    best.effects = round.model;
    last = round.fit;
  }
  const fit::FitOptions found = best;
  if (!out.rounds.empty()) prune_unless_worse(table, options, joint, *last, best);
  auto fitted = fit::method_choice::fit(table, best);
  if (!fitted) fitted = fit::method_choice::fit(table, found);
  if (!fitted) return tl::unexpected(fitted.error());
  out.fit = std::move(*fitted);
  return out;
}

}  // namespace mgtd::calib::criticism::search
