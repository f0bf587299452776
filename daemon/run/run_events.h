// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "daemon/plan/run_plan.h"
#include "daemon/run/run_judgement.h"
#include "proto/epoch.h"
#include "proto/error.h"
#include "proto/health.h"
#include "proto/operator_prompt.h"
#include "proto/reading.h"
#include "proto/run_status.h"
#include "proto/slot.h"

/// An Event is anything that can happen to a run.
namespace mgtd::daemon::run {

enum class Request { pause, resume, abort, finish, redo };  ///< of the operator
[[nodiscard]] constexpr std::string_view name(Request request) {
  constexpr std::string_view kNames[] = {"pause", "resume", "abort", "finish", "redo"};
  return kNames[static_cast<std::size_t>(request)];
}

using ScaleEntered = ScaleEntry;  ///< the answer of the operator

struct Tick {};  ///< time passes; every 20-50 ms

/// The link was live and is no more. This event must come before the faults that the device reports on losing
/// its port.
struct DeviceLost {
  Slot slot;
  std::string why;
};
struct DeviceBack {
  Slot slot;
};
struct DeviceFaulted {
  Slot slot;
  DeviceFault fault;
};
/// Now and then, at least once before the preflight ends.
struct LinkSeen {
  Slot slot;
  LinkHealth health;
};

/// What the stream concludes from its readings: sensors are exchanged or turned. Empty: no longer.
struct ReadingsSay {
  std::string measured, remedy;
};

/// The answer to StorePose.
struct PoseStored {
  int number{0};
  Result<void> result;
};

/// The answer to DropPoses.
struct PosesDropped {
  std::vector<int> numbers;
  Result<void> result;
};

/// What a calibration from the poses stored so far would be worth. Comes when it is known, after some poses.
struct AccuracyKnown {
  int poses{0};
  double tensor_sd_nT_per_m{0};  ///< worst component, by the calibration alone
};

/// The answer to JudgeRun. Numbers follow those of the plan.
struct FurtherPoses {
  RunJudgement judgement;
  std::vector<plan::PlannedPose> poses;  ///< none: nothing more is measured
};

/// The answer to StartSolve: a calibration, whether it passed its checks, and which.
struct Solution {
  bool accepted{false};
  std::string calibration_id;
  std::vector<std::string> reasons;  ///< why it was not accepted
  std::vector<Check> checks;
  std::string left_over{};  ///< what the model does not explain; empty when it fits to the noise
};
struct SolveDone {
  Result<Solution> result;
};
/// The answer to ProposeCalibration.
struct CalibrationProposed {
  Result<void> result;
};

using Event =
    std::variant<Tick, Request, ScaleEntered, Epoch, Gap, ScalarReading, AuxiliaryReading, TableReading,
                 LinkSeen, DeviceLost, DeviceBack, DeviceFaulted, ReadingsSay, PoseStored, PosesDropped,
                 AccuracyKnown, FurtherPoses, SolveDone, CalibrationProposed>;

}  // namespace mgtd::daemon::run
