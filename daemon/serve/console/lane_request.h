// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "daemon/serve/console/lane_history.h"
#include "proto/error.h"

/// A page asks for one lane at a time, so that no answer is long:
///
///     GET /lane?channel=xx&window_s=3600&columns=600
///     {"channel":"xx","from_s":..,"step_s":..,"mean":[..],"least":[..],"greatest":[..],
///      "gaps":[{"from_s":..,"to_s":..,"why":"s2: silent"}]}          null where there was no sample
namespace mgtd::daemon::serve::console {

struct LaneRequest {
  std::string channel;
  double window_s{3600};     ///< 1 to 86400
  std::size_t columns{600};  ///< 1 to 2000
};

/// `query`: what stands behind the question mark.
[[nodiscard]] Result<LaneRequest> parse_lane_request(std::string_view query);
/// JSON.
[[nodiscard]] Result<std::string> answer(const LaneRequest& request, const LaneHistory& history);

}  // namespace mgtd::daemon::serve::console
