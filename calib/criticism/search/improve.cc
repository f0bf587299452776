// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/improve.h"

#include <memory>

#include "calib/criticism/search/model_stage.h"
#include "calib/criticism/search/prune.h"
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
  prune(table, options.effects.size(), tidy, fit);
  const auto before = fit::joint::left_out_nT(last), after = fit::joint::left_out_nT(fit);
  if (before && (!after || *after > kHeldOutVeto * *before)) return;
  const auto residual_nT = [](const fit::joint::JointFit& f) {
    return fit::joint::pose_residuals(f.problem, f.state).residual_nT();
  };
  if (!before && residual_nT(fit) > kHeldOutVeto * residual_nT(last)) return;
  best.effects = std::move(tidy.effects);
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

Result<ImproveReport> improve(const PoseTable& table, const fit::FitOptions& options) {
  const auto explained =
      explain(table, {.fit = options, .rounds = static_cast<int>(kImproveRounds), .candidate_effects = {}});
  if (!explained) return tl::unexpected(explained.error());
  ImproveReport out{
      .finding = explained->left, .stopped = stop_of(*explained), .notes = explained->notes, .fit = {}};
  const fit::joint::JointOptions joint = fit::joint::joint_options(options);
  std::shared_ptr<const fit::joint::JointFit> last = explained->fit;
  std::optional<double> held_out = fit::joint::left_out_nT(*last);
  fit::FitOptions best = options;
  for (const Round& round : explained->rounds) {
    const auto after = fit::joint::left_out_nT(*round.fit);
    if (held_out && after && *after > kHeldOutVeto * *held_out) {
      out.stopped = ImproveStop::held_out_error_rises;
      out.refused = RefusedEffect{round.added.spec, *held_out, *after};
      out.finding = Finding::partial;
      break;
    }
    out.rounds.push_back({.added = round.added,
                          .possible = round.possible,
                          .rms_before_nT = round.rms_before_nT,
                          .rms_after_nT = round.rms_after_nT,
                          .held_out_before_nT = held_out,
                          .held_out_after_nT = after,
                          .predicted_fall = round.added.fall,
                          .realised_fall = round.chi2_before - round.chi2_after,
                          .price = variance_price(*last, *round.fit)});
    best.effects = round.model;
    held_out = after;
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
