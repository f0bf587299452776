// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "daemon/plan/run_plan.h"
#include "daemon/run/field_guard.h"
#include "daemon/run/hand_entry.h"
#include "daemon/run/run_actions.h"
#include "daemon/run/run_config.h"
#include "daemon/run/run_events.h"
#include "daemon/run/run_identity.h"
#include "daemon/run/run_phase.h"
#include "daemon/run/run_progress.h"
#include "daemon/run/table_track.h"
#include "daemon/run/wiring_watch.h"

/// RunFsm is a calibration run as a state machine: events and the time go in, actions come out. It reads no
/// clock and touches nothing; the caller carries out the actions in their order and brings the answers back
/// as events.
///
///     preflight -> homing -> [ asking? -> moving -> settling -> dwelling -> stored ]* -> judging? -> solving
///                                                        |  A           A                    |          |
///                                                        V  | calm      +--- further poses --+          V
///                                                     suspended                             done | rejected
///
/// With everything that can interrupt it, as the status shows it; the tests of a run see all of these changes
/// and no others (run_states_test.cc):
///
///     aborting   => aborted
///     asking     => aborting moving paused solving
///     dwelling   => aborting asking homing moving paused solving suspended
///     homing     => aborting asking moving paused
///     moving     => aborting asking homing paused settling solving
///     paused     => aborted aborting asking dwelling failed homing moving preflight solving
///     preflight  => aborted aborting failed homing paused solving
///     settling   => aborting dwelling homing moving paused
///     solving    => aborted aborting asking done failed homing moving paused rejected
///     suspended  => aborting moving paused
///
/// - What is set by hand (the mounting of the array, the scales of a table without motors) is asked for, and
///   the entry is what is stored. An entry that disagrees with the turn of the field is asked for again; the
///   same entry once more stands. No answer within answer_max_s pauses the run; nothing is assumed. Redo asks
///   for the last entry again and measures again what rests on it.
/// - What a list wants done by hand before a pose is asked for too, and resume says that it is done.
/// - A pose that cannot be used (not settled, disturbed, gaps, saturated, frozen) is measured again, up to
///   `retries` times; then the run pauses with what was measured, the limit and what to do.
/// - A field that changes while the table stands, or that is at another level than at the pose before,
///   suspends the dwell (field_guard.h); the pose is measured again, by itself, when the field was calm for
///   calm_s, and the run pauses when it does not become so within calm_max_s.
/// - The table does not move between StorePose and its PoseStored.
/// - A fault of a device, or a pose that cannot be stored or taken out again, stops the table and pauses. A
///   device that is lost stops the table; the pose is repeated when it comes back within lost_max_s, else the
///   run fails. Meanwhile the run says what the link says. A table that is lost itself is stopped by its
///   driver when it is back; until then it may still move, and the run says so.
/// - A sensor that is not the one that the active calibration was made with, by what the devices tell or by
///   what the stream concludes, pauses the run before its first pose, once: an operator who means it so
///   resumes. One that is not the one that this run began with pauses it for as long as it is there.
/// - Abort stops the table in every state; the run is `aborted` once the table was seen at rest, or after
///   stop_max_s. Nothing is proposed then.
/// - The run ends early, with the fit of the poses so far, when the operator says so (finish), or when the
///   tensor is known as well as wanted. A dwell under way is then still used, a move is not.
/// - A run that goes on until it is explained is judged when its plan is measured (judge_run.h). What the
///   judgement asks for is planned behind the rest and on disk before the table moves; then it is judged
///   again.
/// - Every target lies within the limits, or the table is not moved.
/// - Poses stored by an earlier life of the run are skipped. A new run whose preflight fails is `failed`; one
///   that has poses already pauses instead.
namespace mgtd::daemon::run {

/// A run that was interrupted: when it began (origin of t_s) and what it has.
struct EarlierLife {
  WallTime started_utc;
  std::set<int> stored;       ///< pose numbers
  double last_t_s{0};         ///< of them; time goes on after it even where the wall clock was set back
  std::vector<Pose> poses{};  ///< the same, where entries are held against the turn of the field
  std::vector<InstrumentIdentity> instruments{};  ///< that they were measured with
};

class RunFsm {
 public:
  /// The run begins with the first step().
  RunFsm(RunConfig config, plan::RunPlan plan, Stamp now,
         const std::optional<EarlierLife>& earlier = std::nullopt);

  [[nodiscard]] std::vector<Action> step(const Event& event, Stamp now);

  /// Why a request has no effect now (ErrorCode::state), or nothing. step() ignores such a request.
  [[nodiscard]] Result<void> possible(Request request) const;
  [[nodiscard]] Result<void> possible(const ScaleEntered& entered) const;
  [[nodiscard]] RunStatus status(Instant now) const;
  [[nodiscard]] bool ended() const { return in<phase::Ended>() != nullptr; }
  [[nodiscard]] const plan::RunPlan& plan() const { return plan_; }
  [[nodiscard]] const RunConfig& config() const { return config_; }

 private:
  // What happens.
  void on(const Tick&) {}
  void on(const Request& request);
  void on(const Epoch& epoch) { on_sample(EpochOrGap{epoch}); }
  void on(const Gap& gap) { on_sample(EpochOrGap{gap}); }
  void on(const ScaleEntered& entered);
  void on(const ScalarReading& reading);
  void on(const AuxiliaryReading& reading);
  void on(const TableReading& reading);
  void on(const LinkSeen& seen);
  void on(const DeviceLost& lost);
  void on(const DeviceBack& back);
  void on(const DeviceFaulted& faulted);
  void on(const ReadingsSay& say);
  void on(const PoseStored& stored);
  void on(const PosesDropped& dropped);
  void on(const AccuracyKnown& known);
  void on(const FurtherPoses& further);
  void on(const SolveDone& solved);
  void on(const CalibrationProposed& proposed);
  void on_sample(const EpochOrGap& item);
  void follow_settling(phase::Moving& moving, const TableReading& reading);
  void look_at_identity(const InstrumentIdentity& who);

  // What time or new data make possible, phase by phase. A phase is gone when another one is entered.
  void advance(phase::Preflighting& now);
  void advance(phase::Homing&);
  void advance(phase::Asking&);
  void advance(phase::Approaching& now);
  void advance(phase::Moving& now);
  void advance(phase::Dwelling& now);
  void advance(phase::Suspended&);
  void advance(phase::Storing&);
  void advance(phase::Paused&) {}
  void advance(phase::Waiting&);
  void advance(phase::Judging&);
  void advance(phase::Solving&);
  void advance(phase::Proposing&);
  void advance(phase::Stopping&);
  void advance(phase::Ended&) {}

  // What comes next.
  void go_on();  ///< judged from what is done: preflight, home, a pose, the fit
  void begin_preflight();
  void begin_pose(std::size_t index);
  void move_to_target();
  void settle_at_scales();
  void begin_dwell(const phase::Moving& moving);
  void store(Pose pose);
  void solve();
  void ask();  ///< what is set by hand
  void suspend(const FieldDisturbance& seen);
  void bad_pose(const Error& why);
  void lost_reference();
  void hold(const std::string& message);  ///< stop and ask the operator
  void finish(RunState state, const std::string& message, const std::string& proposed = {});

  // What the operator wants.
  void abort();
  void finish_early();
  void redo();
  void carried_out();

  template <class P>
  [[nodiscard]] const P* in() const {
    return std::get_if<P>(&phase_);
  }
  template <class P>
  [[nodiscard]] P* in() {
    return std::get_if<P>(&phase_);
  }
  void enter(Phase phase, std::string message);
  [[nodiscard]] bool asks_for_deed() const { return in<phase::Asking>() && hands_.wants_deed(); }
  [[nodiscard]] bool watches_field() const {
    return in<phase::Preflighting>() || in<phase::Dwelling>() || in<phase::Suspended>();
  }
  [[nodiscard]] bool timed_out(double limit_s) const { return now_.mono - entered_ > from_seconds(limit_s); }
  [[nodiscard]] const plan::PlannedPose& planned() const { return plan_.poses[progress_.index()]; }
  [[nodiscard]] bool identity_settled();  ///< false: the run is held
  [[nodiscard]] std::optional<TableAngles> waypoint() const;
  [[nodiscard]] bool reached(const TableReading& reading, const TableAngles& goal) const;
  [[nodiscard]] std::optional<Instant> stopped(std::optional<Instant> on_target) const;
  [[nodiscard]] Instant wished_begin(const phase::Moving& moving) const;
  [[nodiscard]] TableAngles angles_at_rest(const phase::Dwelling& dwelling) const;
  [[nodiscard]] Result<void> undisturbed(const Pose& pose) const;
  [[nodiscard]] std::string pose_of() const;    ///< "pose 3 of 157"
  [[nodiscard]] std::string kept() const;       ///< "the 12 poses measured are kept"
  [[nodiscard]] std::string in_status() const;  ///< the message, with what became known since
  void publish();
  void flush_path();
  template <class A>
  void act(A action) {
    actions_.emplace_back(std::move(action));
  }

  RunConfig config_;
  plan::RunPlan plan_;
  RunProgress progress_;
  Stamp run_start_;

  Stamp now_;  ///< of the step under way
  std::vector<Action> actions_;
  Phase phase_;
  Instant entered_;  ///< the phase
  std::string message_;
  std::optional<Instant> published_;  ///< the status; empty: it has changed since

  HandEntry hands_;
  FieldGuard field_;
  TableTrack table_;
  RunIdentity identity_;
  WiringWatch wiring_;

  bool preflight_passed_{false};
  std::vector<Check> checks_;
  std::map<std::string, std::string> lost_;  ///< devices and why, as their links know it
  struct Open {
    std::optional<Pose> unanswered{};  ///< whose PoseStored is awaited
    std::vector<int> undropped{};  ///< poses that could not be dropped; tried again before the run goes on
  };
  Open disk_;
  struct Known {
    std::optional<double> tensor_sd_nT_per_m;
    std::string judged;
  };
  Known known_;  ///< of the poses so far
};

}  // namespace mgtd::daemon::run
