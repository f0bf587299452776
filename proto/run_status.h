// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proto/check.h"
#include "proto/operator_prompt.h"

/// RunStatus says in one object whether a run is going on, how far it is and how it ended.
namespace mgtd {

enum class RunState : std::uint8_t {
  idle,       ///< no run, or the last one was acknowledged
  preflight,  ///< checking rates, noise, saturation, field
  homing,
  asking,  ///< waits for what the operator enters: `prompt`
  moving,
  settling,
  dwelling,
  suspended,  ///< the field is disturbed: the pose is measured again once it is calm, by itself
  paused,
  solving,
  aborting,
  done,      ///< a calibration is proposed
  rejected,  ///< measured and solved, but a check failed: nothing proposed
  aborted,
  failed,
  interrupted,  ///< the daemon died during the run; it can be resumed
};
[[nodiscard]] std::string_view name(RunState state);
/// True while a run has the table.
[[nodiscard]] bool is_active(RunState state);

/// How far the field has changed so far while the table stands. Above the limit, and where noise does not
/// account for it, the pose is measured again.
struct FieldChange {
  double change_nT{0}, limit_nT{0};
};

struct RunStatus {
  std::string run_id;
  RunState state{RunState::idle};
  std::string set;  ///< of the pose under way
  int pose{0};      ///< poses finished
  int poses{0};     ///< poses in the plan
  int retries{0};   ///< poses measured again because a check failed
  double elapsed_s{0};
  double remaining_s{0};  ///< estimate
  std::string message;   ///< one sentence for the operator: what is happening, or why it ended and what to do
  std::string proposed;  ///< calibration id when done
  bool goes_on{false};   ///< paused, but by itself: it waits for a device that is lost
  std::vector<Check> checks;  ///< of the preflight and of the calibration
  /// Of the tensor by the calibration, from the poses so far, worst component; empty until they tell.
  std::optional<double> tensor_sd_nT_per_m;
  std::optional<OperatorPrompt> prompt;       ///< while asking
  std::optional<FieldChange> field_change{};  ///< while the field is watched
  std::string judged{};  ///< what the poses said when the plan was measured, and what followed from it
  std::optional<double> wanted_tensor_sd_nT_per_m;  ///< at which the run ends early
};

}  // namespace mgtd
