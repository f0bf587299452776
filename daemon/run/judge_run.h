// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "calib/criticism/search/explain_report.h"
#include "calib/criticism/search/next_pair.h"
#include "calib/discovery/discovery_report.h"
#include "calib/poses/pose_table.h"
#include "daemon/run/run_judgement.h"
#include "proto/requested_pose.h"

/// judge_run() judges a run as far as it is measured, and chooses what to measure next so that its verdict
/// becomes clear.
///
/// Where several effects could have made the residual, or several formulas (mgt discover) what no effect
/// explains, the best action of `mgt next` is taken: one that the rig can do alone before one that needs
/// hands.
///
/// Nothing more is measured when the verdict is clear, when nothing that is known would make it so within the
/// minutes that are left, and after kMostJudgements looks. Each look declares the true name impossible in one
/// of 1000 runs, all five together in at most one of 200, as a single look at a finished run does. The search
/// for formulas has the same share of its error rates at each look.
///
/// What is named in part is no end: where no formula is open, effects that stay open beside one another are
/// told apart; and where an effect of the library accounts for what explain() leaves, formulas are looked for
/// once more beside it. Effects that describe a part may stand in for a law of no library: where formulas
/// account for everything without them, their names are taken back (remaining_law.h).
namespace mgtd::daemon::run {

struct NextPoses {
  RunJudgement judgement;
  std::vector<RequestedPose> poses{};  ///< numbered from 1; none: nothing more is measured
};

/// What the offline commands say of the run.
struct RunEvidence {
  const PoseTable& table;
  const calib::criticism::search::ExplainReport& explained;
  std::optional<calib::criticism::search::NextReport> next{};
  std::optional<calib::discovery::DiscoveryReport> discovered{};
  std::vector<std::string> beside{};  ///< effects of the library that the search found before that, specs
  std::vector<std::string> model{};   ///< that it was searched beside and the run does not keep, specs

  /// They took the place of all that explain() named.
  [[nodiscard]] bool formulas_account_for_all() const;
  [[nodiscard]] bool leaves_formulas_open() const;
};

/// `looks_left`: after this one.
[[nodiscard]] NextPoses next_poses(const RunEvidence& evidence, double minutes_left, int looks_left);

/// All of it, of poses at hand.
[[nodiscard]] Result<NextPoses> judge(const PoseTable& table, calib::fit::FitOptions options,
                                      double minutes_left, int looks_left);

/// Reads a run file and judges it. Takes what it needs from the file alone, so it may run on any thread.
[[nodiscard]] Result<NextPoses> judge_run(const std::filesystem::path& run_file, double minutes_left,
                                          int looks_left, std::stop_token stop = {});

}  // namespace mgtd::daemon::run
