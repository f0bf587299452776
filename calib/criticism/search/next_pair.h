// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calib/criticism/search/explain.h"

/// Which further measurement would tell two effects apart, for a pair that is asked about or for what explain
/// leaves open.
namespace mgtd::calib {

struct NextStep {
  NextMeasurement measurement;
  bool by_the_rig{false};   ///< attitudes, approach and dwells are all it takes; no hand, heat or coil
  std::vector<Pose> poses;  ///< to be measured: attitude, set, sense, waits; no readings
};

struct NextReport {
  std::string effect{}, rival{};  ///< specs; empty when nothing is open
  double d{0};                    ///< size of the effect as found, in its standard deviations
  bool assumed{false};            ///< it was too small to be seen: the smallest that is stands for it
  double p_right_before{0};
  std::vector<NextStep> steps{};  ///< best first
  std::string text{};             ///< why there is nothing to settle, or nothing that helps
};

/// `pair`: two effects, by name or spec; empty: the verdict's own. Refuses a pair of which one cannot be
/// tested on this run, with what would make it testable.
[[nodiscard]] Result<NextReport> next_of(const PoseTable& table, const ExplainOptions& options,
                                         const std::optional<std::pair<std::string, std::string>>& pair);

[[nodiscard]] nlohmann::json to_json(const NextReport& report);
[[nodiscard]] std::string to_text(const NextReport& report);

/// The poses of a step as CSV: attitude, approach and dwell, in the columns of a pose table, without
/// readings. Where a hand is needed, `note` of the first says for what.
[[nodiscard]] std::string pose_list(const NextStep& step);

}  // namespace mgtd::calib
