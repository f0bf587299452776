// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/improve.h"

#include <fmt/format.h>

#include <cmath>

#include "calib/criticism/polish.h"
#include "calib/criticism/model_stage.h"
#include "calib/fit/joint_errors.h"
#include "calib/fit/joint_report.h"

namespace mgtd::calib {
namespace {

constexpr std::size_t kRounds = 24;

struct Stage {
  JointFit fit;
  std::optional<double> held_out_nT;
};

Result<Stage> stage_of(const PoseTable& table, const JointOptions& options) {
  auto fit = fit_joint_at_size(table, options);
  if (!fit) return tl::unexpected(fit.error());
  Stage out{.fit = std::move(*fit), .held_out_nT = {}};
  if (const auto errors = held_out_errors(out.fit)) out.held_out_nT = errors->residual_rms_nT;
  return out;
}

/// The model tidied up, where the error on poses left out does not rise.
void polish(const PoseTable& table, const FitOptions& options, const JointOptions& joint, const Stage& before,
            FitOptions& best) {
  JointOptions tidy = joint;
  tidy.effects = best.effects;
  auto effects = polished(table, tidy, options.effects.size());
  if (!effects) return;
  tidy.effects = *std::move(effects);
  const auto after = stage_of(table, tidy);
  if (!after) return;
  if (before.held_out_nT && after->held_out_nT && *after->held_out_nT > kHeldOutVeto * *before.held_out_nT) return;
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
      return "something stands out, and nothing that stands for it could be added" +
             (explained.notes.empty() ? std::string() : ": " + explained.notes.back());
  }
}

}  // namespace

Result<ImproveReport> improve(const PoseTable& table, const FitOptions& options) {
  const auto explained =
      explain(table, {.fit = options, .rounds = static_cast<int>(kRounds), .suspects = {}});
  if (!explained) return tl::unexpected(explained.error());
  ImproveReport out{.finding = explained->left, .stopped = stop_text(*explained), .fit = {}};
  JointOptions joint = joint_options(options);
  auto before = stage_of(table, joint);
  if (!before) return tl::unexpected(before.error());
  FitOptions best = options;
  for (std::size_t i = 0; i < explained->rounds.size(); ++i) {
    const Round& round = explained->rounds[i];
    joint.effects = round.model;
    auto after = stage_of(table, joint);
    if (!after) return tl::unexpected(after.error());
    if (before->held_out_nT && after->held_out_nT && *after->held_out_nT > kHeldOutVeto * *before->held_out_nT) {
      out.stopped =
          fmt::format("{} was not added: on poses left out the error rises from {:.4g} to {:.4g} nT",
                      round.added.spec, *before->held_out_nT, *after->held_out_nT);
      out.finding = Finding::partial;
      break;
    }
    out.rounds.push_back({.added = round.added,
                          .possible = round.possible,
                          .rms_before_nT = round.rms_before_nT,
                          .rms_after_nT = round.rms_after_nT,
                          .held_out_before_nT = before->held_out_nT,
                          .held_out_after_nT = after->held_out_nT,
                          .predicted_fall = round.added.fall,
                          .realised_fall = round.chi2_before - round.chi2_after,
                          .price = variance_price(before->fit, after->fit)});
    best.effects = joint.effects;
    before = std::move(after);
  }
  if (!out.rounds.empty()) polish(table, options, joint, *before, best);
  auto fitted = fit(table, best);
  if (!fitted) return tl::unexpected(fitted.error());
  out.fit = std::move(*fitted);
  return out;
}

}  // namespace mgtd::calib
