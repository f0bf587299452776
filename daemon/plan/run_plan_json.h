// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "daemon/plan/run_plan.h"

/// The plan as JSON is kept in the run file and shown by a dry run.
///
///   { "schema":"mgtd.plan/1", "options":{...}, "notes":[...], "poses":[ { "number":1, "set":"standard",
///     "azimuth_deg":..., "pitch_deg":..., "roll_deg":..., "dwell_s":..., "sense":1, "mount":null,
///     "mounting":null, "revisit_of":null, "since_stop_s":null, "note":null }, ... ] }
namespace mgtd::daemon::plan {

[[nodiscard]] nlohmann::json to_json(const RunPlan& plan);

/// {"azimuth":[-180,180],"pitch":[..],"roll":[..]}, in degrees.
[[nodiscard]] nlohmann::json to_json(const drivers::TableLimits& limits);
/// Gives back what the two wrote: `options` of a plan, and limits.
[[nodiscard]] Result<PlanOptions> plan_options_from_json(const nlohmann::json& options);
[[nodiscard]] Result<drivers::TableLimits> table_limits_from_json(const nlohmann::json& limits);

/// Gives back exactly the plan that was written; anything else is refused with the place of the mistake.
[[nodiscard]] Result<RunPlan> plan_from_json(std::string_view text);

}  // namespace mgtd::daemon::plan
