// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "proto/error.h"

/// The control socket speaks JSON: one object per line, one answer per request, in the order of the requests.
///
///   {"cmd":"run.start","args":{"step_deg":10,"random":121},"id":7}
///   {"ok":true,"id":7,"result":{...}}
///   {"ok":false,"id":7,"error":{"code":"state","message":"..","remedy":".."}}
///
/// `args` may be left out; `id` is the client's own (number, text or absent) and comes back as it was.
///
///   version              {"software","rig","protocol":{"major","minor"},"stream_tcp","stream_unix"}
///   status               STATUS (status_codec.h)
///   run.start            args: run_request.h            -> RUN
///   run.dry-run          args: run_request.h            -> {"poses","minutes","text","list":[...]}
///   run.pause, run.resume, run.finish, run.abort, run.status       -> RUN
///   run.enter            args: what the scales say (operator_prompt.h)                       -> RUN
///   run.redo             what was entered last is asked for again                            -> RUN
///   run.course           what the run has gained so far             -> run_course.h
///   run.events           what the run wrote down of itself          -> run_log.h
///   magnet-test.start, magnet-test.status, magnet-test.stop        -> magnet_status.h
///   calibrations.list    -> {"calibrations":[{"id","state","since","origin","forced","why","by"}]}
///   calibrations.history                              -> {"decisions","moves","figure","unreadable"}
///   calibrations.show    args: calibration_request.h  -> CAL.json
///   calibrations.accept  args: calibration_request.h  -> {"active"}
///   calibrations.import  args: calibration_request.h  -> {"id","forced"}, and "active" when accepted
///   calibrations.reject  args: calibration_request.h  -> {"rejected"}
///   calibrations.rollback                             -> {"active"}
///   control.take         args: control_hold.h         -> the holder
///   control.release                                   -> {}
///   console              {"address","token","refused"}: of the web console; address null where there is none
///   control.break        takes control from whoever has it        -> {"was": holder or null}
///
/// What changes something needs control, which one connection has at a time (the daemon's control_lease.h).
namespace mgtd {

inline constexpr int kControlProtocolMajor = 1;
inline constexpr int kControlProtocolMinor = 8;
/// A calibration with a hundred coefficients takes 0.4 MB.
inline constexpr std::size_t kControlLineLimit = 1 << 20;

enum class ControlCommand : std::uint8_t {
  version,
  status,
  run_start,
  run_dry_run,
  run_pause,
  run_resume,
  run_finish,
  run_abort,
  run_status,
  run_enter,
  run_redo,
  run_course,
  run_events,
  calibrations_list,
  calibrations_history,
  calibrations_show,
  calibrations_accept,
  calibrations_import,
  calibrations_reject,
  calibrations_rollback,
  magnet_start,
  magnet_status,
  magnet_stop,
  control_take,
  control_release,
  control_break,
  console,
};
inline constexpr std::array<std::string_view, 27> kControlCommandNames{"version",
                                                                       "status",
                                                                       "run.start",
                                                                       "run.dry-run",
                                                                       "run.pause",
                                                                       "run.resume",
                                                                       "run.finish",
                                                                       "run.abort",
                                                                       "run.status",
                                                                       "run.enter",
                                                                       "run.redo",
                                                                       "run.course",
                                                                       "run.events",
                                                                       "calibrations.list",
                                                                       "calibrations.history",
                                                                       "calibrations.show",
                                                                       "calibrations.accept",
                                                                       "calibrations.import",
                                                                       "calibrations.reject",
                                                                       "calibrations.rollback",
                                                                       "magnet-test.start",
                                                                       "magnet-test.status",
                                                                       "magnet-test.stop",
                                                                       "control.take",
                                                                       "control.release",
                                                                       "control.break",
                                                                       "console"};
[[nodiscard]] std::string_view name(ControlCommand command);

struct ControlRequest {
  ControlCommand command{ControlCommand::version};
  nlohmann::json args = nlohmann::json::object();  ///< always an object
  nlohmann::json id;                               ///< null when the client sent none
  std::string from{};  ///< who asks, in words; the server says it, never the client
};

/// A request that could not be read, with the id to answer under as far as it could be told.
struct ControlRefusal {
  Error error;
  nlohmann::json id;
};

[[nodiscard]] tl::expected<ControlRequest, ControlRefusal> parse_control(std::string_view line);

/// Lines without the line end.
[[nodiscard]] std::string encode(const ControlRequest& request);
[[nodiscard]] std::string encode_reply(const nlohmann::json& id,
                                       const Result<nlohmann::ordered_json>& result);

/// What a reply says: its result, or the error the daemon reported. A line that is no reply is an error too.
struct ControlReply {
  nlohmann::json id;
  Result<nlohmann::json> result;
};
[[nodiscard]] Result<ControlReply> parse_reply(std::string_view line);

}  // namespace mgtd
