// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "daemon/acquire/instrument_watch.h"
#include "daemon/plan/run_plan.h"
#include "daemon/run/dwell.h"
#include "daemon/run/preflight.h"
#include "daemon/run/rotation_consistency.h"
#include "daemon/run/run_actions.h"
#include "daemon/run/run_config.h"
#include "daemon/run/run_events.h"
#include "daemon/run/run_progress.h"
#include "daemon/run/settle.h"
#include "daemon/run/wiring.h"

/// A calibration run as a state machine: events and the time in, actions out. It reads no clock and touches
/// nothing; the caller carries out the actions in their order and brings the answers back as events.
///
///     preflight -> homing -> [ asking? -> moving -> settling -> dwelling -> stored ]* -> solving -> done |
///                                                        |  A                                rejected
///                                                        V  | calm
///                                                     suspended
///
/// - What is set by hand (the mounting of the array, the scales of a table without motors) is asked for, and
///   the entry is what is stored. An entry that disagrees with the turn of the field is asked for again; the
///   same entry once more stands. No answer within answer_max_s pauses the run; nothing is assumed. Redo asks
///   for the last entry again and measures again what rests on it.
/// - What a list wants done by hand before a pose is asked for too, and resume says that it is done.
/// - A pose that cannot be used (not settled, disturbed, gaps, saturated, frozen) is measured again, up to
///   `retries` times; then the run pauses with what was measured, the limit and what to do.
/// - A field that changes while the table stands (field_disturbance.h), or that is at another level than at
///   the pose before, suspends the dwell; the pose is measured again, by itself, when the field was calm for
///   calm_s, and the run pauses when it does not become so within calm_max_s.
/// - The table does not move between StorePose and its PoseStored.
/// - A fault of a device, or a pose that cannot be stored, stops the table and pauses. A device that is lost
///   stops the table; the pose is repeated when it comes back within lost_max_s, else the run fails.
///   Meanwhile the run says what the link says. A table that is lost itself is stopped by its driver when it
///   is back; until then it may still move, and the run says so.
/// - A sensor that is not the one that the active calibration was made with, by what the devices tell or by
///   what the stream concludes, pauses the run before its first pose, once: an operator who means it so
///   resumes. One that is not the one that this run began with pauses it for as long as it is there.
/// - Abort stops the table in every state; the run is `aborted` once the table was seen at rest, or after
///   stop_max_s. Nothing is proposed then.
/// - The run ends early, with the fit of the poses so far, when the operator says so (finish), or when the
///   tensor is known as well as wanted. A dwell under way is then still used, a move is not.
/// - Every target lies within the limits, or the table is not moved.
/// - Poses stored by an earlier life of the run are skipped. A new run whose preflight fails is `failed`; one
///   that has poses already pauses instead.
namespace mgtd::daemon {

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
  RunFsm(RunConfig config, RunPlan plan, Stamp now, const std::optional<EarlierLife>& earlier = std::nullopt);

  [[nodiscard]] std::vector<Action> step(const Event& event, Stamp now);

  /// Why a request has no effect now (ErrorCode::state), or nothing. step() ignores such a request.
  [[nodiscard]] Result<void> possible(Request request) const;
  [[nodiscard]] Result<void> possible(const ScaleEntered& entered) const;
  [[nodiscard]] RunStatus status(Instant now) const;
  [[nodiscard]] bool ended() const { return phase_ == Phase::ended; }
  [[nodiscard]] const RunPlan& plan() const { return plan_; }

 private:
  enum class Phase {
    preflight,
    homing,
    asking,       ///< the operator, for what is set by hand
    approaching,  ///< to a point before the target, so that the azimuth arrives in its planned sense
    moving,       ///< and settling
    dwelling,
    suspended,  ///< until the field is calm
    storing,
    paused,   ///< until the operator says
    waiting,  ///< for a lost device
    solving,
    proposing,
    stopping,  ///< aborted; the table is not yet seen at rest
    ended,
  };

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
  void on(const AccuracyKnown& known);
  void on(const SolveDone& solved);
  void on(const CalibrationProposed& proposed);
  void on_sample(const EpochOrGap& item);
  void follow_settling(const TableReading& reading);
  void follow_rest(const TableReading& reading);

  void pause();
  void abort();
  void finish_early();
  void redo();

  // What is set by hand.
  [[nodiscard]] bool ask_hands();  ///< for the pose under way; false: nothing is to be asked
  void ask(OperatorPrompt::What what, std::string again);
  void carried_out();
  [[nodiscard]] bool asks_for_deed() const {
    return phase_ == Phase::asking && prompt_->what == OperatorPrompt::What::note;
  }
  void drop(const std::vector<std::size_t>& poses);
  [[nodiscard]] bool believed(const Pose& pose);  ///< false: asked again
  [[nodiscard]] bool by_hand() const;             ///< anything in this run
  [[nodiscard]] TableAngles recorded(const TableAngles& table) const;

  /// Decisions that time or new data make possible.
  void advance();
  void advance_preflight();
  void advance_homing();
  void advance_approach();
  void advance_move();
  void advance_dwell();
  void advance_suspended();
  void advance_stopping();

  /// What comes next, judged from what is done: preflight, home, a pose, the fit.
  void go_on();
  void enter(Phase phase, std::string message);
  void enter_preflight();
  void enter_homing();
  void enter_pose(std::size_t index);
  void move_to_target();
  void settle_at_scales();
  [[nodiscard]] Instant wished_begin() const;
  void enter_dwell();
  void store(Pose pose);
  // The field at rest.
  [[nodiscard]] std::optional<Instant> stopped() const;
  void watch_field(Instant from);
  [[nodiscard]] bool watching_field() const {
    return phase_ == Phase::preflight || phase_ == Phase::dwelling || phase_ == Phase::suspended;
  }
  [[nodiscard]] std::optional<FieldDisturbance> disturbed(double length_s);
  [[nodiscard]] std::optional<std::string> at_another_level(std::optional<double> f_nT) const;
  void suspend(const std::string& why);

  void look_at_wiring(const Pose& pose);
  // Who measures.
  void look_at_identity(const InstrumentIdentity& who);
  [[nodiscard]] Check identity_check() const;
  [[nodiscard]] bool identity_settled();  ///< false: the run is held
  void lost_reference();
  void bad_pose(const Error& why);
  void hold(const std::string& message);  ///< stop and ask the operator
  void finish(RunState state, const std::string& message);

  [[nodiscard]] bool measuring() const;  ///< preflight .. storing, waiting
  [[nodiscard]] bool timed_out(double limit_s) const { return now_.mono - entered_ > from_seconds(limit_s); }
  [[nodiscard]] std::optional<TableAngles> waypoint(const PlannedPose& pose) const;
  [[nodiscard]] TableReading judged(TableReading reading) const;
  [[nodiscard]] TableAngles angles_at_rest() const;
  [[nodiscard]] Result<void> undisturbed(const Pose& pose) const;
  [[nodiscard]] const PlannedPose& planned() const { return plan_.poses[index_]; }
  [[nodiscard]] std::string kept() const;
  [[nodiscard]] std::string in_status() const;  ///< the message, with what became known since
  [[nodiscard]] RunState state() const;
  void publish();
  void flush_path();
  template <class A>
  void act(A action) {
    actions_.emplace_back(std::move(action));
  }

  RunConfig config_;
  RunPlan plan_;
  RunProgress progress_;
  Stamp run_start_;

  Stamp now_;  ///< of the step under way
  std::vector<Action> actions_;
  Phase phase_{Phase::preflight};
  Instant entered_;  ///< the phase
  std::string message_;
  std::optional<Instant> published_;
  bool changed_{true};  ///< the status, since it was published

  Preflight preflight_;
  bool preflight_passed_{false};
  bool homed_{false};
  std::optional<TableReading> table_;        ///< latest
  std::vector<TableReading> path_;           ///< not yet stored
  std::map<std::string, std::string> lost_;  ///< and why, as their links know it

  std::size_t index_{0};      ///< of the pose under way
  int attempt_{0};            ///< failed ones of this pose
  int retries_{0};            ///< of the run
  TableAngles goal_;          ///< of the move under way
  std::optional<int> sense_;  ///< of the last azimuth move
  std::optional<Settle> settle_;
  std::optional<Dwell> dwell_;
  std::vector<TableAngles> at_rest_;  ///< reported during the dwell
  /// The first word of the table at rest here, whatever it was told since.
  std::optional<TableReading> rests_;
  std::optional<FieldBlocks> still_;  ///< since the table stands; in the preflight, too
  std::size_t judged_{0};             ///< blocks of it
  FieldNoise field_noise_;
  std::optional<double> level_nT_;          ///< of the scalar reference at the last good pose
  std::optional<Instant> disturbed_since_;  ///< this pose, by whatever comes and goes
  std::optional<int> unanswered_;           ///< number of the pose whose PoseStored is awaited

  std::optional<OperatorPrompt> prompt_;
  std::optional<int> mounted_;          ///< mounting of the array, by number ...
  TableAngles mounting_;                ///< ... and as it was entered
  std::optional<int> scales_of_;        ///< pose whose scales were entered ...
  TableAngles scales_;                  ///< ... and what they say
  std::optional<int> forgotten_;        ///< pose whose scales were entered when the run was paused
  std::optional<int> noted_;            ///< pose whose note was carried out
  bool unproved_{false};                ///< the last entry was not yet held against the field
  bool doubtful_{false};                ///< the operator stands by it: others are not held against its poses
  std::optional<TableAngles> doubted_;  ///< the entry that disagreed with it
  std::optional<TableAngles> far_;      ///< the entry that was far from what was asked for
  std::optional<Pose> stored_;          ///< whose PoseStored is awaited, for field_turn_
  std::optional<std::size_t> last_stored_;
  RotationConsistency field_turn_;

  std::optional<double> tensor_sd_nT_per_m_;
  bool enough_{false};  ///< no further pose
  Wiring wiring_;
  std::vector<std::string> wiring_told_;
  InstrumentWatch own_{kByRun}, calibrated_{kByCalibration};
  std::vector<InstrumentIdentity> answering_;  ///< by place
  ReadingsSay readings_say_;
  std::string confirmed_;  ///< what was said of another sensor before the operator resumed
  std::vector<Check> checks_;
  std::string proposed_, left_over_;
  RunState final_{RunState::idle};
};

}  // namespace mgtd::daemon
