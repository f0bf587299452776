// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <variant>
#include <vector>

#include "daemon/plan/run_plan.h"
#include "daemon/run/field_disturbance.h"
#include "daemon/run/run_judgement.h"
#include "proto/pose.h"
#include "proto/reading.h"
#include "proto/run_status.h"

/// An Action is anything that a run can ask for; actions are carried out in the order given.
namespace mgtd::daemon::run {

struct HomeTable {};
struct MoveTable {
  TableAngles target;
};
/// A table that is turned by hand stands here now: its scales say so.
struct SetTable {
  TableAngles angles;
};
struct StopTable {};  ///< also of a table at rest; never refused

/// Answered by PoseStored once it is on disk. The table does not move before.
struct StorePose {
  Pose pose;
};
/// Poses that rest on an entry that was wrong: they are measured again. Answered by PosesDropped.
struct DropPoses {
  std::vector<int> numbers;
};
/// What the table did since the last one, on the wall clock of the run (run_clock.h). Not answered: a run
/// does not depend on it.
struct StorePath {
  std::vector<TableReading> readings;
};
struct StoreChecks {
  std::string stage;  ///< "preflight" or "verdict"
  std::vector<Check> checks;
};

/// The field did not stand still at a pose: the run waits until it is calm.
struct FieldDisturbed {
  int pose{0};
  FieldDisturbance seen;
};

/// Judge the poses of the run as far as it is measured. Answered by FurtherPoses.
struct JudgeRun {};
/// What was judged, and the plan that follows from it: on disk before the table moves.
struct StoreJudgement {
  RunJudgement judgement;
  plan::RunPlan plan;
};

/// Fit all poses of the run. Answered by SolveDone.
struct StartSolve {};
struct CancelSolve {};  ///< or JudgeRun; an answer that still comes is ignored
/// Answered by CalibrationProposed. The active calibration is never touched by a run.
struct ProposeCalibration {
  std::string calibration_id;
};

/// At every change and once a second.
struct PublishStatus {
  RunStatus status;
};
/// A line for the run's own log and the daemon's.
struct Record {
  std::string what;
};
/// The last action of a run: done, rejected, aborted or failed.
struct Finish {
  RunState state{RunState::failed};
  std::string message;
};

using Action = std::variant<HomeTable, MoveTable, SetTable, StopTable, StorePose, DropPoses, StorePath,
                            StoreChecks, FieldDisturbed, JudgeRun, StoreJudgement, StartSolve, CancelSolve,
                            ProposeCalibration, PublishStatus, Record, Finish>;

}  // namespace mgtd::daemon::run
