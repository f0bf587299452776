// SPDX-License-Identifier: Apache-2.0
// What the run asks to be done: poses and checks to disk, fits to the worker.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "calib/fit/joint/accuracy_so_far.h"
#include "calib/report/fit_reasons.h"
#include "daemon/acquire/calibrated_with.h"
#include "daemon/plan/run_plan_json.h"
#include "daemon/run/expected_accuracy.h"
#include "daemon/run/further_poses.h"
#include "daemon/run/run_executor.h"
#include "daemon/run/solver.h"

namespace mgtd::daemon::run {

void RunExecutor::act(const DropPoses& action, Stamp) {
  auto dropped = file_->remove_poses(action.numbers);
  if (dropped) {
    course_.dropped(action.numbers);
    std::erase_if(poses_.poses, [&](const Pose& pose) {
      return std::find(action.numbers.begin(), action.numbers.end(), pose.number) != action.numbers.end();
    });
  }
  run_.answer(PosesDropped{action.numbers, std::move(dropped)});
}

void RunExecutor::act(const StorePose& action, Stamp) {
  auto stored = file_->append_pose(action.pose);
  if (stored) {
    poses_.poses.push_back(action.pose);
    course_.measured(action.pose);
    if (poses_.poses.size() == 1) expect_accuracy();
    learn_accuracy();
  }
  run_.answer(PoseStored{action.pose.number, std::move(stored)});
}

void RunExecutor::keep_course(Stamp now) {
  const auto kept = course_.take_unkept();
  if (!kept) return;
  if (auto stored = file_->set_document(kCourse, to_json(*kept).dump()); !stored)
    hooks_.warn("course of the run", stored.error().text(), now.mono);
}

/// One fit at a time; what was stored meanwhile is fitted after it.
void RunExecutor::learn_accuracy() {
  if (learning_) return;
  learning_ = true;
  learning_job_ = worker_.run(
      [poses = poses_, near = warm_start_,
       options = fit_options(file_->header().options)](std::stop_token stop) mutable {
        options.stop = std::move(stop);
        return calib::fit::joint::accuracy_so_far(poses, options, near.get());
      },
      [this, generation = generation_,
       count = poses_.poses.size()](Result<calib::fit::joint::AccuracySoFar> known) {
        if (generation != generation_ || !active()) return;
        learning_ = false;
        if (!known) course_.not_known(known.error().message);
        if (known) {
          course_.known(known->poses, known->tensor_sd_nT_per_m, known->fit);
          if (std::isfinite(known->worst_nT_per_m()))
            run_.answer(AccuracyKnown{known->poses, known->worst_nT_per_m()});
          warm_start_ = std::make_shared<const calib::fit::joint::JointState>(std::move(known->state));
        }
        if (poses_.poses.size() != count) learn_accuracy();
      });
}

/// Of the plan, once its first pose tells the noise.
void RunExecutor::expect_accuracy() {
  auto request = planned_design(config_, run_.fsm()->plan(), poses_.poses.front());
  if (!request) return;
  expecting_job_ = worker_.run([request = *std::move(request)](
                                   const std::stop_token& stop) { return expected_accuracy(request, stop); },
                               [this, generation = generation_](std::vector<CourseAccuracy> expected) {
                                 if (generation == generation_) course_.expects(std::move(expected));
                               });
}

void RunExecutor::act(const StorePath& action, Stamp now) {
  if (auto stored = file_->append_path(action.readings); !stored)
    hooks_.warn("table path", stored.error().text(), now.mono);
}

void RunExecutor::act(const StoreChecks& action, Stamp now) {
  if (auto stored = file_->set_checks(action.stage, action.checks); !stored)
    hooks_.warn("checks", stored.error().text(), now.mono);
}

void RunExecutor::act(const JudgeRun&, Stamp) {
  learning_job_.request_stop();
  expecting_job_.request_stop();
  const LooksLeft left = left_after(judgements_, file_->header().options.until_explained_min.value_or(0));
  solving_job_ = worker_.run(
      [path = file_->path(), left](std::stop_token stop) {
        return judge_run(path, left.minutes, left.looks, std::move(stop));
      },
      [this, generation = generation_](const Result<NextPoses>& next) {
        if (generation == generation_ && active())
          run_.answer(further_poses(next, run_.fsm()->plan(), limits()));
      });
}

void RunExecutor::act(const StoreJudgement& action, Stamp now) {
  judgements_.push_back(action.judgement);
  course_.extend(action.plan);
  if (!poses_.poses.empty()) expect_accuracy();
  auto stored = file_->set_document(kJudgements, to_json(judgements_).dump());
  if (stored && action.judgement.minutes > 0)
    stored = file_->set_document(kExtendedPlan, to_json(action.plan).dump());
  if (!stored) hooks_.warn("judgement of the run", stored.error().text(), now.mono);
}

void RunExecutor::act(const StartSolve&, Stamp) {
  learning_job_.request_stop();  // what it would say is part of what follows
  expecting_job_.request_stop();
  solving_job_ = worker_.run(
      [path = file_->path(), solve = hooks_.solve](std::stop_token stop) {
        return solve(path, std::move(stop));
      },
      [this, generation = generation_](Result<calib::fit::FitReport> report) {
        if (generation != generation_ || !active()) return;
        SolveDone done{tl::unexpected(Error{})};
        if (const auto active = store_.active(); report && active && *active)
          acquire::hold_against(**active, *report);
        if (report) {
          const calib::calibration::Calibration& c = report->calibration;
          done.result = Solution{c.accepted_by_checks, c.id, calib::report::fit_reasons(*report), c.checks,
                                 calib::report::lack_of_fit_text(*report)};
          solved_ = c;
          course_.known(c.poses, report->tensor_sd_nT_per_m,
                        calib::fit::joint::fit_so_far(c.covariance, c.sensors.size(), report->residual_nT));
        } else {
          done.result = tl::unexpected(report.error());
        }
        run_.answer(std::move(done));
      });
}

void RunExecutor::act(const CancelSolve&, Stamp) { solving_job_.request_stop(); }

void RunExecutor::act(const ProposeCalibration& action, Stamp now) {
  Result<void> proposed =
      fail(ErrorCode::internal, fmt::format("calibration {} was not solved here", action.calibration_id));
  if (solved_ && solved_->id == action.calibration_id)
    proposed = store_.propose(*solved_, file_->header().run_id, now.wall);
  if (proposed) {
    if (auto kept = file_->set_document("proposed", calib::calibration::to_json_text(*solved_)); !kept)
      hooks_.warn("the proposal in the run file", kept.error().text(), now.mono);
  }
  run_.answer(CalibrationProposed{std::move(proposed)});
}

void RunExecutor::act(const PublishStatus& action, Stamp now) {
  course_.shows(action.status, now);
  keep_course(now);
  // The file knows the state it would be found in after a crash.
  if (const auto known = file_->state();
      known && known->state != action.status.state && is_active(action.status.state)) {
    if (auto set = file_->set_state(action.status.state, action.status.message); !set)
      hooks_.warn("run state", set.error().text(), now.mono);
  }
  hooks_.publish(action.status);
}

void RunExecutor::act(const Record& action, Stamp now) {
  spdlog::info("run: {}", action.what);
  if (auto stored = file_->append_event({now, action.what}); !stored)
    hooks_.warn("run log", stored.error().text(), now.mono);
}

void RunExecutor::act(const Finish& action, Stamp) {
  spdlog::info("run ended, {}: {}", name(action.state), action.message);
  if (auto set = file_->set_state(action.state, action.message); !set)
    spdlog::error("run state: {}", set.error().text());
  failed_.reset();
  if (action.state == RunState::failed) failed_ = resumable(*file_);
}

}  // namespace mgtd::daemon::run
