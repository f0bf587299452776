// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "calib/fit/joint/accuracy_so_far.h"
#include "daemon/config/config.h"
#include "daemon/plan/run_duration.h"
#include "daemon/run/course_recorder.h"
#include "daemon/run/current_run.h"
#include "daemon/run/run_judgement.h"
#include "daemon/run/solver.h"
#include "daemon/store/calibration_store.h"
#include "daemon/store/run_file.h"
#include "daemon/store/run_files.h"
#include "daemon/store/worker.h"
#include "proto/journal_note.h"
#include "proto/run_log.h"
#include "proto/run_request.h"

/// RunExecutor begins runs and carries out what they ask for: it keeps the run file, has the worker solve,
/// and proposes the calibration. (The core gives the table its orders itself.) A run that a dead daemon left
/// behind is found at start and offered. After each pose the worker says what the calibration would be worth
/// so far.
namespace mgtd::daemon::run {

struct RunHooks {
  std::function<const drivers::TableLimits&()> limits;  ///< as the table knows them by now
  std::function<LinkHealth()> table;
  std::function<void(const RunStatus&)> publish;
  /// What repeats is for the owner's QuietLog: topic, message.
  std::function<void(std::string_view, const std::string&, Instant)> warn;
  /// Fits a run file, on the worker, until it is told to stop.
  std::function<Result<calib::fit::FitReport>(const std::filesystem::path&, std::stop_token)> solve{
      [](const std::filesystem::path& path, std::stop_token stop) {
        return solve_run(path, std::move(stop));
      }};
};

class RunExecutor {
 public:
  RunExecutor(const config::Config& config, std::filesystem::path directory, store::CalibrationStore& store,
              store::Worker& worker, CurrentRun& run, RunHooks hooks);

  /// Looks for a run that was under way when the daemon died, and for the last run, if that failed.
  void find_interrupted();

  [[nodiscard]] Result<plan::RunPlan> plan(const RunRequest& request) const;
  [[nodiscard]] plan::Pace pace() const;
  [[nodiscard]] const drivers::TableLimits& limits() const { return hooks_.limits(); }
  /// Refused while a run is active, or one is waiting to be resumed or aborted.
  [[nodiscard]] Result<void> start(const RunRequest& request, Stamp now);
  /// Resume and abort also settle an interrupted run; resume takes up the last run when it failed. A new run
  /// leaves a failed one where it is.
  [[nodiscard]] Result<void> request(Request request, Stamp now);

  /// What the scales say that the run asks for. Refused when it asks for nothing.
  [[nodiscard]] Result<void> enter(const ScaleEntry& scales, Stamp now);

  void carry_out(const Action& action, Stamp now) {
    std::visit([&](const auto& a) { act(a, now); }, action);
  }
  [[nodiscard]] RunStatus status(Instant now) const;
  [[nodiscard]] bool active() const { return run_.active(); }
  /// Of the run under way, or of the last one of this life of the daemon.
  [[nodiscard]] RunCourse course() const { return course_.course(); }
  /// What its file has written down: of the run under way, the last one of this life of the daemon, or the
  /// one that waits to be resumed.
  [[nodiscard]] Result<RunLog> log() const;
  /// The daemon ends: the run file is left to be resumed.
  void abandon();

 private:
  struct Interrupted {
    std::filesystem::path file;
    std::string run_id;
    int stored{0}, planned{0};
  };

  [[nodiscard]] RunConfig run_config(const std::string& run_id) const;
  [[nodiscard]] static std::optional<Interrupted> resumable(const store::RunFile& file);
  [[nodiscard]] Result<void> table_is_there() const;
  [[nodiscard]] Result<void> tells_tensor(const RunRequest& request) const;
  [[nodiscard]] Result<void> resume_interrupted(Stamp now);
  [[nodiscard]] Result<void> drop_interrupted();
  [[nodiscard]] static RunStatus status_of(const Interrupted& run, RunState state, std::string message) {
    RunStatus out;
    out.run_id = run.run_id;
    out.state = state;
    out.pose = run.stored;
    out.poses = run.planned;
    out.message = std::move(message);
    return out;
  }
  void begin(store::RunFile file, RunConfig config, plan::RunPlan plan, Stamp now,
             const std::optional<EarlierLife>& earlier);
  void learn_accuracy();
  void expect_accuracy();
  void keep_course(Stamp now);
  void act(const HomeTable&, Stamp) {}  // the core's, as are the next three
  void act(const MoveTable&, Stamp) {}
  void act(const SetTable&, Stamp) {}
  void act(const StopTable&, Stamp) {}
  void act(const DropPoses& action, Stamp);
  void act(const StorePose& action, Stamp now);
  void act(const StorePath& action, Stamp now);
  void act(const StoreChecks& action, Stamp now);
  void act(const FieldDisturbed& action, Stamp now) {
    course_.disturbed(action.pose, action.seen, now);
    keep_course(now);
  }
  void act(const JudgeRun&, Stamp now);
  void act(const StoreJudgement& action, Stamp now);
  void act(const StartSolve&, Stamp now);
  void act(const CancelSolve&, Stamp);
  void act(const ProposeCalibration& action, Stamp now);
  void act(const PublishStatus& action, Stamp now);
  void act(const Record& action, Stamp now);
  void act(const Finish& action, Stamp);

  const config::Config& config_;
  store::RunFiles files_;
  store::CalibrationStore& store_;
  store::Worker& worker_;
  CurrentRun& run_;
  RunHooks hooks_;
  std::optional<store::RunFile> file_;
  PoseTable poses_;  ///< stored so far; the worker gets copies
  CourseRecorder course_;
  std::shared_ptr<const calib::fit::joint::JointState> warm_start_;  ///< of the last fit while measuring
  bool learning_{false};                                             ///< the worker is at such a fit
  std::stop_source learning_job_{std::nostopstate}, expecting_job_{std::nostopstate},
      solving_job_{std::nostopstate};
  std::vector<RunJudgement> judgements_;  ///< of the run, as its file has them
  std::optional<calib::calibration::Calibration> solved_;
  std::optional<Interrupted> interrupted_;
  std::optional<RunStatus> given_up_;  ///< the interrupted run, until another begins
  /// The last run, when it failed with poses on disk: resume takes it up.
  std::optional<Interrupted> failed_;
  std::uint64_t generation_{0};
};

}  // namespace mgtd::daemon::run
