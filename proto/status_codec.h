// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "proto/error.h"
#include "proto/run_status.h"
#include "proto/status_report.h"

/// STATUS and RUN have the same JSON on the stream, on the control socket and in `mgt status --json`.
///
/// RUN:    {"run_id","state","set","pose","poses","retries","elapsed_s","remaining_s","message","goes_on",
///          "prompt": operator_prompt.h or null,"field_change":{"change_nT","limit_nT"} or
///          null,"tensor_sd_nT_per_m","wanted_tensor_sd_nT_per_m", "proposed": id or
///          null,"checks":[{"name","passed","measured","limit","remedy"}]}
/// STATUS: {"t","t_ns","uptime_s","software","rig","speed_up","cal": id or null,
///          "calibration":{"forced","left_out":[{"effect","lacks"}],"age_s",
///                         "made_at_degC":[a number or null per sensor],"now_degC":[the same]},
///          "criticism":{"state","measured","limit","remedy"},
///          "devices":[{"name","driver","port","state","detail","identity","bytes_in","bytes_in_frames",
///                      "bytes_rejected","bytes_resync","bytes_pending","bytes_out","frames",
///                      "rejected":{"length":0,..},"opens","closes","balanced","last_frame_age_s",
///                      "state_since_s","rate_hz",
///                      "clock":{"rate_error","rate_error_pm","bound_s","delivery_s","settled","trouble"}
///                              or null}],
///          "inputs":[{"name","device","input","unit","value","age_s"}],
///          "sampler":{"epochs","gaps","rate_hz","skew_bound_s"},
///          "stream":{"clients","accepted","refused","dropped","dropped_for":{..},"last_drop","gaps"},
///          "control":{as stream but gaps, "holder": control_hold.h},
///          "journal":{"state","why","bytes","bytes_lost","stops"},"ring":{as journal},"oldest_seq",
///          "disk_free_bytes","run":{RUN},"magnet": magnet_status.h or null}
/// The stream puts "class" before these keys. What is not known is null; NaN becomes null.
namespace mgtd {

[[nodiscard]] nlohmann::ordered_json to_json(const RunStatus& run);
[[nodiscard]] nlohmann::ordered_json to_json(const StatusReport& report);

/// Reads what to_json wrote; a missing or mistyped key is named. Keys it does not know are passed over, so
/// that an older tool reads a newer daemon.
[[nodiscard]] Result<RunStatus> run_status_from_json(const nlohmann::json& object);

}  // namespace mgtd
