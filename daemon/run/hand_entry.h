// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "daemon/plan/run_plan.h"
#include "daemon/run/rotation_consistency.h"
#include "drivers/device.h"
#include "proto/error.h"
#include "proto/operator_prompt.h"
#include "proto/pose.h"

/// HandEntry keeps what a run asks its operator to set by hand and what the operator entered: the mounting of
/// the array on the table, the scales of a table without motors, a note to carry out.
///
/// An entry that is far from what was asked for is asked for again, and so is one that disagrees with the
/// turn of the field since the poses before it (RotationConsistency). The same entry a second time is the
/// operator's word: it stands, and the poses measured with it are not held against others. Angles in radians.
///
/// Pure: the run stops the table, shows the prompt, and waits.
namespace mgtd::daemon::run {

class HandEntry {
 public:
  /// `scales`: the table is turned by hand. `earlier`: poses of an earlier life of the run.
  HandEntry(bool scales, const plan::RunPlan& plan, const std::vector<Pose>& earlier);

  void extend(std::size_t poses) { poses_ = poses; }  ///< of the plan

  /// Anything in this run is set by hand.
  [[nodiscard]] bool used() const { return scales_ || mounts_first_; }
  /// The way between two poses is known, and so is the attitude of the array on the table.
  [[nodiscard]] bool way_known() const { return !scales_ && (!mounts_ || mounted_); }

  /// What has to be asked before this pose can be measured; false: nothing.
  [[nodiscard]] bool ask_before(const plan::PlannedPose& pose);
  [[nodiscard]] const std::optional<OperatorPrompt>& prompt() const { return prompt_; }
  /// The prompt as one sentence; it begins with why the entry is asked for once more.
  [[nodiscard]] std::string question() const;
  /// The note of a pose wants something done; nothing is to be entered.
  [[nodiscard]] bool wants_deed() const { return prompt_ && prompt_->what == OperatorPrompt::What::note; }
  void carried_out(const plan::PlannedPose& pose);

  /// Why angles cannot be the answer to the prompt (ErrorCode::usage).
  [[nodiscard]] Result<void> possible(const TableAngles& angles, const drivers::TableLimits& limits) const;
  /// "pose 7: entered the scales of the table: azimuth 20, pitch 0, roll 0 deg".
  [[nodiscard]] std::string said(const TableAngles& angles) const;
  /// False: it is asked for once more.
  [[nodiscard]] bool enter(const TableAngles& angles, const plan::PlannedPose& pose);

  /// What the scales of a table that is turned by hand say.
  [[nodiscard]] const TableAngles& scales() const { return table_; }
  /// The attitude of the platform, where the table stands at these angles.
  [[nodiscard]] TableAngles platform(const TableAngles& table) const;

  struct Judgement {
    bool stands{true};      ///< false: the entry is asked for once more
    std::string against{};  ///< what speaks against an entry that the operator stands by
  };
  /// Holds the last entry against the first pose that was measured with it.
  [[nodiscard]] Judgement judge(const Pose& measured, const plan::PlannedPose& pose);
  void stored(const Pose& pose);
  void dropped(int number) { turns_.remove(number); }

  /// The run is paused: a hand may be at the table meanwhile, and its scales are asked for again.
  void paused();
  void resumed() { forgotten_.reset(); }

  /// Something was entered that could be entered again.
  [[nodiscard]] bool entered() const { return mounted_ || table_of_ || forgotten_; }
  /// What rests on the last entry, which is forgotten.
  struct Forgotten {
    std::optional<int> mount{};  ///< all poses of this mounting
    bool last_pose{false};       ///< the pose that was stored last
  };
  [[nodiscard]] Forgotten forget(const plan::PlannedPose& under_way);

 private:
  void ask(OperatorPrompt::What what, const plan::PlannedPose& pose, std::string again);

  const bool scales_;
  bool mounts_first_, mounts_;  ///< the first pose, any pose, has a mounting of its own
  std::size_t poses_;
  std::optional<OperatorPrompt> prompt_;
  std::optional<int> mounted_;            ///< mounting of the array, by number ...
  TableAngles mounting_;                  ///< ... and as it was entered
  std::optional<int> table_of_;           ///< pose whose scales were entered ...
  TableAngles table_;                     ///< ... and what they say
  std::optional<int> forgotten_;          ///< pose whose scales were entered when the run was paused
  std::optional<int> noted_;              ///< pose whose note was carried out
  bool unproved_{false};                  ///< the last entry was not yet held against the field
  bool doubtful_{false};                  ///< the operator stands by an entry that disagrees with the field
  std::optional<TableAngles> disagreed_;  ///< the entry that did
  std::optional<TableAngles> far_;        ///< the entry that was far from what was asked for
  RotationConsistency turns_;
};

}  // namespace mgtd::daemon::run
