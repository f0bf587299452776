// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/improve.h"

#include <fmt/format.h>

#include <memory>

#include "calib/criticism/search/model_stage.h"
#include "calib/criticism/search/prune.h"
#include "calib/fit/joint/cross_validation.h"
#include "calib/fit/joint/joint_report.h"
#include "calib/fit/joint/pose_residuals.h"

namespace mgtd::calib {
namespace {

constexpr std::size_t kRounds = 24;

/// The model tidied up, where the error on poses left out does not rise; where that cannot be told, the
/// residual.
void polish(const PoseTable& table, const FitOptions& options, const JointOptions& joint,
            const JointFit& last, FitOptions& best) {
  JointOptions tidy = joint;
  tidy.effects = best.effects;
  tidy.worse = last.worse;
  JointFit fit = last;
  polished(table, options.effects.size(), tidy, fit);
  const auto before = left_out_nT(last), after = left_out_nT(fit);
  if (before && (!after || *after > kHeldOutVeto * *before)) return;
  const auto residual_nT = [](const JointFit& f) { return pose_residuals(f.problem, f.state).residual_nT(); };
  if (!before && residual_nT(fit) > kHeldOutVeto * residual_nT(last)) return;
  best.effects = std::move(tidy.effects);
}

std::string stop_text(const ExplainReport& explained) {
  switch (explained.left) {
    case Finding::unknown:
      return "something is left that no effect of the library looks like";
    case Finding::bad_data:
      return "the data contradict themselves";
    case Finding::pass:
      return "nothing stands out any more";
    default:
      if (explained.rounds.size() >= kRounds) return "the number of rounds is reached";
      return "something stands out, and nothing that stands for it could be added";
  }
}

}  // namespace

Result<ImproveReport> improve(const PoseTable& table, const FitOptions& options) {
  const auto explained =
      explain(table, {.fit = options, .rounds = static_cast<int>(kRounds), .suspects = {}});
  if (!explained) return tl::unexpected(explained.error());
  ImproveReport out{
      .finding = explained->left, .stopped = stop_text(*explained), .notes = explained->notes, .fit = {}};
  const JointOptions joint = joint_options(options);
  std::shared_ptr<const JointFit> last = explained->fit;
  std::optional<double> held_out = left_out_nT(*last);
  FitOptions best = options;
  for (const Round& round : explained->rounds) {
    const auto after = left_out_nT(*round.fit);
    if (held_out && after && *after > kHeldOutVeto * *held_out) {
      out.stopped =
          fmt::format("{} was not added: on poses left out the error rises from {:.4g} to {:.4g} nT",
                      round.added.spec, *held_out, *after);
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
  const FitOptions found = best;
  if (!out.rounds.empty()) polish(table, options, joint, *last, best);
  auto fitted = fit(table, best);
  if (!fitted) fitted = fit(table, found);
  if (!fitted) return tl::unexpected(fitted.error());
  out.fit = std::move(*fitted);
  return out;
}

}  // namespace mgtd::calib
