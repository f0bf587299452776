// SPDX-License-Identifier: Apache-2.0
// What the rig answers on its control socket.
#include <fmt/format.h>

#include "calib/calibration_json.h"
#include "daemon/rig.h"
#include "daemon/run_plan_json.h"
#include "proto/status_codec.h"

namespace mgtd::daemon {

using Reply = Result<nlohmann::ordered_json>;

Reply Rig::answer(const ControlRequest& request) {
  switch (request.command) {
    case ControlCommand::version:
      return nlohmann::ordered_json{
          {"software", "mgtd " MGTD_VERSION},
          {"rig", config_.rig_name},
          {"protocol", {{"major", kControlProtocolMajor}, {"minor", kControlProtocolMinor}}},
          {"stream_tcp", config_.stream_tcp},
          {"stream_unix", config_.stream_unix}};
    case ControlCommand::status:
      return to_json(report());
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
    case ControlCommand::calibrations_show:
    case ControlCommand::calibrations_accept:
    case ControlCommand::calibrations_rollback:
      return answer_calibrations(request);
  }
  return fail(ErrorCode::internal, "a command without an answer");
}

Reply Rig::answer_run(const ControlRequest& request) {
  const Stamp now = clock_.now();
  Result<void> done;
  if (request.command == ControlCommand::run_start || request.command == ControlCommand::run_dry_run) {
    const auto wanted = parse_run_request(request.args);
    if (!wanted) return tl::unexpected(wanted.error());
    if (request.command == ControlCommand::run_dry_run) return dry_run(*wanted);
    done = run_.start(*wanted, now);
  } else if (request.command == ControlCommand::run_pause) {
    done = run_.request(Request::pause, now);
  } else if (request.command == ControlCommand::run_resume) {
    done = run_.request(Request::resume, now);
  } else if (request.command == ControlCommand::run_finish) {
    done = run_.request(Request::finish, now);
  } else if (request.command == ControlCommand::run_redo) {
    done = run_.request(Request::redo, now);
  } else if (request.command == ControlCommand::run_enter) {
    const auto scales = parse_scale_entry(request.args);
    if (!scales) return tl::unexpected(scales.error());
    done = run_.enter(*scales, now);
  } else if (request.command == ControlCommand::run_abort) {
    done = run_.request(Request::abort, now);
  }
  if (!done) return tl::unexpected(done.error());
  watch_links(now);
  return to_json(run_.status(now.mono));
}

Reply Rig::dry_run(const RunRequest& request) const {
  const auto plan = run_.plan(request);
  if (!plan) return tl::unexpected(plan.error());
  return nlohmann::ordered_json{{"poses", plan->poses.size()},
                                {"minutes", total_s(run_.pace(), *plan) / 60},
                                {"text", describe(*plan, run_.pace())},
                                {"list", to_json(*plan)["poses"]}};
}

Reply Rig::answer_calibrations(const ControlRequest& request) {
  const WallTime now = clock_.now().wall;
  if (request.command == ControlCommand::calibrations_list) {
    auto list = nlohmann::ordered_json::array();
    for (const CalibrationEntry& e : store_.list()) {
      list.push_back(
          {{"id", e.id}, {"state", name(e.state)}, {"since", format_utc(e.since)}, {"origin", e.origin}});
    }
    return nlohmann::ordered_json{{"calibrations", std::move(list)}};
  }
  if (request.command == ControlCommand::calibrations_rollback) {
    const auto back = store_.rollback(now);
    if (!back) return tl::unexpected(back.error());
    use_active_calibration();
    return nlohmann::ordered_json{{"active", *back}};
  }
  const auto id = parse_calibration_id(request.args);
  if (!id) return tl::unexpected(id.error());
  if (request.command == ControlCommand::calibrations_show) {
    const auto calibration = store_.show(*id);
    if (!calibration) return tl::unexpected(calibration.error());
    return nlohmann::ordered_json(calib::to_json(*calibration));
  }
  if (auto accepted = store_.accept(*id, now); !accepted) return tl::unexpected(accepted.error());
  use_active_calibration();
  return nlohmann::ordered_json{{"active", *id}};
}

}  // namespace mgtd::daemon
