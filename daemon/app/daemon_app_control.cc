// SPDX-License-Identifier: Apache-2.0
// What the rig answers on its control socket.
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include <cmath>

#include "calib/calibration/calibration_json.h"
#include "calib/report/described_array.h"
#include "daemon/app/daemon_app.h"
#include "daemon/plan/run_plan_json.h"
#include "proto/calibration_request.h"
#include "proto/status_codec.h"
#include "proto/version.h"

namespace mgtd::daemon::app {

using Reply = Result<nlohmann::ordered_json>;

Reply DaemonApp::answer(const ControlRequest& request) {
  switch (request.command) {
    case ControlCommand::version:
      return nlohmann::ordered_json{
          {"software", software()},
          {"rig", config_.rig_name},
          {"protocol", {{"major", kControlProtocolMajor}, {"minor", kControlProtocolMinor}}},
          {"stream_tcp", config_.stream.tcp},
          {"stream_unix", config_.stream.unix_path}};
    case ControlCommand::status:
      return to_json(report());
    case ControlCommand::console:
      return nlohmann::ordered_json{
          {"address", console_.server.address().empty() ? nlohmann::ordered_json()
                                                        : nlohmann::ordered_json(console_.server.address())},
          {"token", console_.server.token().text()},
          {"refused", console_.server.refused()}};
    case ControlCommand::run_course:
      return to_json(run_.course());
    case ControlCommand::run_events: {
      const auto log = run_.log();
      if (!log) return tl::unexpected(log.error());
      return to_json(*log);
    }
    case ControlCommand::run_start:
    case ControlCommand::run_dry_run:
    case ControlCommand::run_pause:
    case ControlCommand::run_resume:
    case ControlCommand::run_finish:
    case ControlCommand::run_abort:
    case ControlCommand::run_status:
    case ControlCommand::run_enter:
    case ControlCommand::run_redo:
      return answer_run(request);
    case ControlCommand::calibrations_list:
    case ControlCommand::calibrations_history:
    case ControlCommand::calibrations_show:
    case ControlCommand::calibrations_accept:
    case ControlCommand::calibrations_import:
    case ControlCommand::calibrations_reject:
    case ControlCommand::calibrations_rollback:
      return answer_calibrations(request);
    case ControlCommand::magnet_start:
    case ControlCommand::magnet_status:
    case ControlCommand::magnet_stop:
      return answer_magnet(request);
    case ControlCommand::control_take:
    case ControlCommand::control_release:
    case ControlCommand::control_break:
      break;  // answered by the control server
  }
  return fail(ErrorCode::internal, "a command without an answer");
}

Reply DaemonApp::answer_run(const ControlRequest& request) {
  const Stamp now = clock_.now();
  const bool begins =
      request.command == ControlCommand::run_start || request.command == ControlCommand::run_resume;
  if (begins && core_.probing())
    return fail(ErrorCode::state, "a magnet test is going on", "wait for its end, or: mgt run abort");
  Result<void> done;
  if (request.command == ControlCommand::run_start || request.command == ControlCommand::run_dry_run) {
    const auto wanted = parse_run_request(request.args);
    if (!wanted) return tl::unexpected(wanted.error());
    if (request.command == ControlCommand::run_dry_run) return dry_run(*wanted);
    done = run_.start(*wanted, now);
  } else if (request.command == ControlCommand::run_pause) {
    done = run_.request(run::Request::pause, now);
  } else if (request.command == ControlCommand::run_resume) {
    done = run_.request(run::Request::resume, now);
  } else if (request.command == ControlCommand::run_finish) {
    done = run_.request(run::Request::finish, now);
  } else if (request.command == ControlCommand::run_redo) {
    done = run_.request(run::Request::redo, now);
  } else if (request.command == ControlCommand::run_enter) {
    const auto scales = parse_scale_entry(request.args);
    if (!scales) return tl::unexpected(scales.error());
    done = run_.enter(*scales, now);
  } else if (request.command == ControlCommand::run_abort) {
    if (core_.probing()) return abort_magnet(now);
    done = run_.request(run::Request::abort, now);
  }
  if (!done) return tl::unexpected(done.error());
  core_.show_links(now);
  return to_json(run_.status(now.mono));
}

Reply DaemonApp::answer_magnet(const ControlRequest& request) {
  if (request.command == ControlCommand::magnet_start) {
    if (auto begun = core_.begin_probe(clock_.now()); !begun) return tl::unexpected(begun.error());
  } else if (request.command == ControlCommand::magnet_stop) {
    core_.stop_probe();
  }
  if (!core_.probe())
    return fail(ErrorCode::state, "there was no magnet test", "mgt run magnet-test begins one");
  return to_json(core_.probe()->status());
}

/// Whose client is gone, too.
Reply DaemonApp::abort_magnet(Stamp now) {
  core_.stop_probe();
  const std::string text = core_.probe()->status().text;
  spdlog::info("magnet test: {}", text);
  RunStatus run = run_.status(now.mono);
  run.message = "the magnet test is ended: " + text;
  return to_json(run);
}

Reply DaemonApp::dry_run(const RunRequest& request) const {
  const auto plan = run_.plan(request);
  if (!plan) return tl::unexpected(plan.error());
  const nlohmann::json whole = to_json(*plan);
  return nlohmann::ordered_json{{"poses", plan->poses.size()},
                                {"minutes", plan::total_s(run_.pace(), *plan) / 60},
                                {"text", plan::describe(*plan, run_.pace())},
                                {"list", whole["poses"]},
                                {"options", whole["options"]},
                                {"limits_deg", plan::to_json(run_.limits())},
                                {"config", config_.text}};
}

Reply DaemonApp::answer_calibrations(const ControlRequest& request) {
  const WallTime now = clock_.now().wall;
  if (request.command == ControlCommand::calibrations_list) {
    auto list = nlohmann::ordered_json::array();
    for (const store::CalibrationEntry& e : store_.list()) {
      list.push_back({{"id", e.id},
                      {"state", name(e.state)},
                      {"since", format_utc(e.since)},
                      {"origin", e.origin},
                      {"forced", e.forced},
                      {"why", e.why},
                      {"by", e.by}});
    }
    return nlohmann::ordered_json{{"calibrations", std::move(list)}};
  }
  if (request.command == ControlCommand::calibrations_history) return history_.report();
  if (request.command == ControlCommand::calibrations_rollback) {
    const auto back = store_.rollback(now, request.from);
    if (!back) return tl::unexpected(back.error());
    spdlog::info("rolled back to calibration {} by {}", *back, request.from);
    use_active_calibration();
    return nlohmann::ordered_json{{"active", *back}};
  }
  if (request.command == ControlCommand::calibrations_import) return import_calibration(request);
  if (request.command == ControlCommand::calibrations_show) {
    const auto id = parse_calibration_id(request.args);
    if (!id) return tl::unexpected(id.error());
    const auto calibration = store_.show(*id);
    if (!calibration) return tl::unexpected(calibration.error());
    return nlohmann::ordered_json(calib::calibration::to_json(*calibration));
  }
  if (request.command == ControlCommand::calibrations_reject) {
    const auto wanted = parse_reject_request(request.args);
    if (!wanted) return tl::unexpected(wanted.error());
    if (auto rejected = store_.reject(wanted->id, wanted->why, now, request.from); !rejected)
      return tl::unexpected(rejected.error());
    spdlog::info("calibration {} is rejected by {}: {}", wanted->id, request.from, wanted->why);
    return nlohmann::ordered_json{{"rejected", wanted->id}};
  }
  const auto wanted = parse_accept_request(request.args);
  if (!wanted) return tl::unexpected(wanted.error());
  if (auto accepted = store_.accept(wanted->id, now, wanted->force, wanted->why, request.from); !accepted)
    return tl::unexpected(accepted.error());
  spdlog::info("calibration {} is accepted by {}{}{}{}", wanted->id, request.from,
               wanted->force ? ", by force" : "", wanted->why.empty() ? "" : ": ", wanted->why);
  use_active_calibration();
  return nlohmann::ordered_json{{"active", wanted->id}};
}

Reply DaemonApp::import_calibration(const ControlRequest& request) {
  const WallTime now = clock_.now().wall;
  const auto wanted = parse_import_request(request.args);
  if (!wanted) return tl::unexpected(wanted.error());
  const auto calibration = calib::calibration::calibration_from_json(wanted->calibration);
  if (!calibration) return tl::unexpected(calibration.error());
  if (!calibration->geometry.agrees_with(config_.geometry())) {
    const auto [its, own] = calib::report::names_apart(calibration->geometry, config_.geometry());
    return fail(ErrorCode::refused,
                fmt::format("calibration {} is of {}, this rig is {}", calibration->id, its, own),
                "fit again with --baseline or --array, or correct [rig] baseline_m or [array] of the "
                "configuration");
  }
  if (auto done = store_.import(*calibration, wanted->origin, wanted->force, now, request.from); !done)
    return tl::unexpected(done.error());
  spdlog::info("calibration {} is imported from {} by {}", calibration->id, wanted->origin, request.from);
  nlohmann::ordered_json reply{{"id", calibration->id}, {"forced", !calibration->accepted_by_checks}};
  if (wanted->accept) {
    if (auto done = store_.accept(calibration->id, now, wanted->force, {}, request.from); !done)
      return tl::unexpected(done.error());
    use_active_calibration();
  }
  if (store_.active_id() == calibration->id) reply["active"] = calibration->id;
  return reply;
}

}  // namespace mgtd::daemon::app
