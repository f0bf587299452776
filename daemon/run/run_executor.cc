// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/run_executor.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <system_error>

#include "calib/fit/joint/joint_problem.h"
#include "calib/report/described_array.h"
#include "daemon/acquire/calibrated_with.h"
#include "daemon/plan/plan_from_list.h"
#include "daemon/plan/run_plan_json.h"
#include "daemon/run/enough_samples.h"
#include "daemon/run/planned_poses.h"
#include "daemon/run/solver.h"
#include "proto/version.h"

namespace mgtd::daemon::run {
namespace {

/// "20261121T100000Z": sorts by time, names the file.
std::string run_id_at(WallTime t) {
  std::string id = format_utc(t).substr(0, 19);
  std::erase_if(id, [](char c) { return c == '-' || c == ':'; });
  return id + "Z";
}

plan::PlanOptions plan_options(const config::Config& config, const RunRequest& r) {
  plan::PlanOptions out = run::plan_options(config);
  out.step_deg = r.step_deg.value_or(out.step_deg);
  out.random = r.random.value_or(out.random);
  out.revisits =
      r.revisits.value_or(r.random ? std::min(out.revisits, std::max(0, (*r.random - 2) / 2)) : out.revisits);
  out.dwell_short_s = r.dwell_short_s.value_or(out.dwell_short_s);
  out.dwell_long_s = r.dwell_long_s.value_or(std::max(out.dwell_long_s, r.dwell_short_s.value_or(0)));
  out.seed = r.seed.value_or(out.seed);
  return out;
}

store::RunOptions run_options(const config::Config& c, const RunRequest& r) {
  store::RunOptions out;
  out.geometry = c.geometry();
  out.sensor_names = store::numbered_sensors(out.geometry.sensors());
  out.field_nT = c.site.field_nT;
  if (c.site.field_nT) out.field_sd_nT = c.site.field_sd_nT;
  if (c.site.inclination_deg) out.inclination_rad = to_rad(*c.site.inclination_deg);
  if (c.site.declination_deg) out.declination_rad = to_rad(*c.site.declination_deg);
  out.table_sd_rad = to_rad(c.site.table_sd_deg);
  out.until_tensor_sd_nT_per_m = r.until_tensor_sd_nT_per_m;
  out.until_explained_min = r.until_explained_min;
  out.retries = r.retries;
  return out;
}

std::optional<Eigen::Vector3d> site_direction(const config::Config& c) {
  if (!c.site.inclination_deg) return std::nullopt;
  return calib::fit::joint::direction_of(to_rad(*c.site.inclination_deg),
                                         to_rad(c.site.declination_deg.value_or(0)));
}

/// With what was planned while it was measured.
Result<plan::RunPlan> plan_of(const store::RunFile& file) {
  const auto extended = file.document(kExtendedPlan);
  if (!extended) return tl::unexpected(extended.error());
  return plan::plan_from_json(*extended ? **extended : file.header().plan);
}

std::vector<RunJudgement> judgements_of(const store::RunFile& file) {
  const auto text = file.document(kJudgements);
  auto judgements = judgements_from_json(text && *text ? **text : std::string());
  return judgements ? *std::move(judgements) : std::vector<RunJudgement>{};
}

Result<KeptCourse> kept_course_of(const store::RunFile& file) {
  const auto text = file.document(kCourse);
  if (!text) return tl::unexpected(text.error());
  return kept_course_from_json(*text ? **text : std::string());
}

Result<RunLog> log_of(const store::RunFile& file) {
  const auto events = file.events();
  if (!events) return tl::unexpected(events.error());
  std::vector<RunLogEntry> entries;
  for (const store::RunEvent& event : *events) entries.push_back({event.at.wall, event.what});
  return latest_of(file.header().run_id, std::move(entries));
}

}  // namespace

RunExecutor::RunExecutor(const config::Config& config, std::filesystem::path directory,
                         store::CalibrationStore& store, store::Worker& worker, CurrentRun& run,
                         RunHooks hooks)
    : config_(config),
      files_(std::move(directory)),
      store_(store),
      worker_(worker),
      run_(run),
      hooks_(std::move(hooks)) {}

/// Nothing for a file whose plan cannot be read.
std::optional<RunExecutor::Interrupted> RunExecutor::resumable(const store::RunFile& file) {
  const auto plan = plan_of(file);
  if (!plan) return std::nullopt;
  return Interrupted{file.path(), file.header().run_id, static_cast<int>(file.pose_count().value_or(0)),
                     static_cast<int>(plan->poses.size())};
}

void RunExecutor::find_interrupted() {
  const auto found = [](const store::RunFiles::Entry& run) -> std::optional<Interrupted> {
    const auto file = store::RunFile::open(run.path, store::Access::read_only);
    return file ? resumable(*file) : std::nullopt;
  };
  const auto runs = files_.last_first();
  if (!runs.empty() && runs.front().state == RunState::failed) failed_ = found(runs.front());
  for (const store::RunFiles::Entry& run : runs) {
    if (!is_active(run.state)) continue;
    interrupted_ = found(run);
    if (!interrupted_) continue;
    failed_.reset();
    spdlog::warn(
        "run {} was interrupted with {} of {} poses on disk: mgt run resume goes on with it, mgt run abort "
        "gives it up",
        interrupted_->run_id, interrupted_->stored, interrupted_->planned);
    return;
  }
}

Result<plan::RunPlan> RunExecutor::plan(const RunRequest& request) const {
  const plan::PlanOptions options = plan_options(config_, request);
  const drivers::TableLimits& limits = hooks_.limits();
  auto planned = request.poses.empty() ? plan::make_plan(options, limits)
                                       : plan::plan_from_list(request, options, limits);
  if (!planned) return planned;
  if (auto enough = enough_samples(*planned, run::run_config(config_, limits)); !enough)
    return tl::unexpected(enough.error());
  return planned;
}

plan::Pace RunExecutor::pace() const { return {}; }

RunConfig RunExecutor::run_config(const std::string& run_id) const {
  RunConfig out = run::run_config(config_, hooks_.limits());
  out.run_id = run_id;
  if (const auto active = store_.active(); active && *active)
    out.calibrated = acquire::instruments_among((*active)->checks);
  out.pace = pace();
  return out;
}

Result<void> RunExecutor::start(const RunRequest& request, Stamp now) {
  if (const RunStatus run = status(now.mono); run.state == RunState::paused && !run.goes_on)
    return fail(ErrorCode::state, fmt::format("run {} is paused: {}", run.run_id, run.message),
                "mgt run resume goes on with it, mgt run abort ends it");
  if (active())
    return fail(ErrorCode::state, fmt::format("run {} is going on", status(now.mono).run_id),
                "wait for it, or: mgt run abort");
  if (interrupted_) {
    return fail(ErrorCode::state,
                fmt::format("run {} was interrupted with {} of {} poses", interrupted_->run_id,
                            interrupted_->stored, interrupted_->planned),
                "mgt run resume goes on with it, mgt run abort gives it up");
  }
  if (auto told = tells_tensor(request); !told) return told;
  if (auto there = table_is_there(); !there) return there;
  auto planned = plan(request);
  if (!planned) return tl::unexpected(planned.error());
  const std::string id = run_id_at(now.wall);
  auto file = files_.create({.run_id = id,
                             .rig = config_.rig_name,
                             .started_utc = now.wall,
                             .software = software(),
                             .config = config_.text,
                             .plan = to_json(*planned).dump(),
                             .seed = planned->options.seed,
                             .source = "measured",
                             .options = run_options(config_, request)});
  if (!file) return tl::unexpected(file.error());
  for (const std::string& effect : config_.effects) {
    if (auto put = file->append_model_step({now.wall, "mgtd configuration", "add", effect, "{}"}); !put)
      return put;
  }
  failed_.reset();
  begin(*std::move(file), run_config(id), *std::move(planned), now, std::nullopt);
  return {};
}

void RunExecutor::begin(store::RunFile file, RunConfig config, plan::RunPlan plan, Stamp now,
                        const std::optional<EarlierLife>& earlier) {
  file_ = std::move(file);
  given_up_.reset();
  const store::RunOptions& wanted = file_->header().options;
  config.until_tensor_sd_nT_per_m = wanted.until_tensor_sd_nT_per_m;
  config.until_explained = wanted.until_explained_min.has_value();
  config.retries = wanted.retries.value_or(config.retries);
  judgements_ = judgements_of(*file_);
  auto stored = file_->poses();
  poses_ = stored ? *std::move(stored) : PoseTable{};
  course_ = CourseRecorder(config.run_id, plan, site_direction(config_), config.until_tensor_sd_nT_per_m);
  for (const Pose& pose : poses_.poses) course_.measured(pose);
  if (auto kept = kept_course_of(*file_)) {
    course_.restore(*std::move(kept));
  } else {
    hooks_.warn("course of the run", kept.error().text(), now.mono);
  }
  warm_start_.reset();
  learning_ = false;
  learning_job_.request_stop();
  expecting_job_.request_stop();
  solving_job_.request_stop();
  solved_.reset();
  ++generation_;
  spdlog::info("run {}: {} poses into {}", config.run_id, plan.poses.size(), file_->path().string());
  run_.begin(std::move(config), std::move(plan), now, earlier);
  if (!poses_.poses.empty()) expect_accuracy();
}

/// A run that ends when the tensor is known well enough needs an array that tells a tensor.
Result<void> RunExecutor::tells_tensor(const RunRequest& request) const {
  if (!request.until_tensor_sd_nT_per_m) return {};
  const auto array = calib::report::described(config_.geometry());
  if (!array.gradient.empty()) return {};
  return fail(ErrorCode::refused, "--until-tensor-sd: the array tells no component of the gradient",
              "leave it out: the run then measures its whole plan");
}

/// How far it may turn is known from itself.
Result<void> RunExecutor::table_is_there() const {
  const LinkHealth table = hooks_.table();
  if (table.state == LinkState::live) return {};
  return fail(ErrorCode::state, "the table is not connected: " + table.detail,
              "when mgt status shows it live, say it again");
}

Result<void> RunExecutor::resume_interrupted(Stamp now) {
  if (auto there = table_is_there(); !there) return there;
  auto file = store::RunFile::open(interrupted_->file, store::Access::resume);
  if (!file) return tl::unexpected(file.error());
  auto plan = plan_of(*file);
  if (!plan) return tl::unexpected(plan.error());
  const auto poses = file->poses();
  if (!poses) return tl::unexpected(poses.error());
  EarlierLife earlier;
  earlier.started_utc = file->header().started_utc;
  for (const Pose& pose : poses->poses) {
    earlier.stored.insert(pose.number);
    earlier.poses.push_back(pose);
    earlier.last_t_s = std::max(earlier.last_t_s, pose.t_s.value_or(0));
  }
  if (const auto known = file->checks(acquire::kInstrumentsStage))
    earlier.instruments = acquire::instruments_among(*known);
  RunConfig config = run_config(file->header().run_id);
  interrupted_.reset();
  begin(*std::move(file), std::move(config), *std::move(plan), now, earlier);
  return {};
}

Result<void> RunExecutor::drop_interrupted() {
  auto file = store::RunFile::open(interrupted_->file, store::Access::resume);
  if (!file) return tl::unexpected(file.error());
  if (auto set = file->set_state(RunState::aborted, "interrupted, then given up by the operator"); !set)
    return set;
  const std::string rest =
      interrupted_->stored == 0
          ? fmt::format("no pose was measured, {} holds nothing to fit; mgt run start begins another run",
                        interrupted_->file.string())
          : fmt::format("its {0} of {1} poses are kept in {2}: mgt fit {2} -o CAL.json fits them",
                        interrupted_->stored, interrupted_->planned, interrupted_->file.string());
  given_up_ = status_of(*interrupted_, RunState::aborted, "given up; " + rest);
  spdlog::info("run {}: {}", given_up_->run_id, given_up_->message);
  interrupted_.reset();
  run_.drop();
  return {};
}

Result<void> RunExecutor::request(Request request, Stamp now) {
  if (!active() && failed_ && request == Request::resume) {
    interrupted_ = std::exchange(failed_, std::nullopt);
    auto resumed = resume_interrupted(now);
    if (!resumed) failed_ = std::exchange(interrupted_, std::nullopt);  // as it was
    return resumed;
  }
  if (interrupted_ && request == Request::resume) return resume_interrupted(now);
  if (interrupted_ && request == Request::abort) return drop_interrupted();
  if (!active()) return fail(ErrorCode::state, "no run is going on", "mgt run start begins one");
  if (auto possible = run_.fsm()->possible(request); !possible) return possible;
  run_.feed(request, now);
  return {};
}

Result<void> RunExecutor::enter(const ScaleEntry& scales, Stamp now) {
  if (!active()) return fail(ErrorCode::state, "no run is going on", "mgt run start begins one");
  if (auto possible = run_.fsm()->possible(scales); !possible) return possible;
  run_.feed(scales, now);
  return {};
}

RunStatus RunExecutor::status(Instant now) const {
  if (run_.fsm() != nullptr) return run_.fsm()->status(now);
  if (interrupted_)
    return status_of(
        *interrupted_, RunState::interrupted,
        "the daemon ended during this run: mgt run resume goes on with it, mgt run abort gives it up");
  if (failed_)
    return status_of(*failed_, RunState::failed,
                     "the last run failed: mgt run resume goes on with it, mgt run start begins another");
  return given_up_.value_or(RunStatus{});
}

Result<RunLog> RunExecutor::log() const {
  if (file_) return log_of(*file_);
  const std::optional<Interrupted>& waiting = interrupted_ ? interrupted_ : failed_;
  if (!waiting) return RunLog{};
  const auto file = store::RunFile::open(waiting->file, store::Access::read_only);
  if (!file) return tl::unexpected(file.error());
  return log_of(*file);
}

void RunExecutor::abandon() {
  if (!active()) return;
  spdlog::warn("run {} is left with its poses on disk; it can be resumed when the daemon is back",
               file_->header().run_id);
}

}  // namespace mgtd::daemon::run
