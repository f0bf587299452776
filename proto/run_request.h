// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "proto/error.h"
#include "proto/requested_pose.h"

/// A RunRequest holds the arguments of the control commands run.start and run.dry-run.
namespace mgtd {

/// What the operator wants otherwise than the configuration says.
struct RunRequest {
  std::optional<double> step_deg;
  std::optional<int> random, revisits, retries;
  std::optional<double> dwell_short_s, dwell_long_s;
  std::optional<std::uint64_t> seed;
  std::optional<double> until_tensor_sd_nT_per_m;  ///< end the run once the tensor is known so well
  std::optional<double>
      until_explained_min;           ///< go on after the plan until the residual is explained, so long
  std::string list;                  ///< name of the file that the poses are from
  std::vector<RequestedPose> poses;  ///< these, in this order, instead of a plan of sets
  bool operator==(const RunRequest&) const = default;
};

/// Refuses an unknown key, a wrong type and a value outside its limits, by name; poses beside what makes a
/// plan of sets.
[[nodiscard]] Result<RunRequest> parse_run_request(const nlohmann::json& args);
[[nodiscard]] nlohmann::json to_json(const RunRequest& request);

}  // namespace mgtd
