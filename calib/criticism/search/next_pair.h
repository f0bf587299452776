// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calib/criticism/search/explain.h"
#include "calib/design/hypothesis_menu.h"

/// next_of() and next_after() find which further measurement would tell two effects apart: a given pair, or
/// the one that explain() left open.
namespace mgtd::calib::criticism::search {

struct NextStep {
  design::NextMeasurement measurement;
  bool by_the_rig{false};  ///< attitudes, approach, waits and dwells are all it takes; no hand, heat or coil
  bool of_another_run{false};  ///< at another place, where it is judged on its own, or on another day
  std::vector<Pose> poses;     ///< to be measured: attitude, set, sense, waits; no readings
};

/// Why no further measurement is asked for.
struct NothingToSettle {
  std::string winner{};   ///< of explain(); empty: nothing stands out on this run
  std::string nearest{};  ///< the most similar effect, which these poses tell apart from it; empty: none
};

struct NextReport {
  std::optional<NothingToSettle> nothing_to_settle{};
  std::optional<Finding> finding{};     ///< of explain(), where it was asked
  std::string effect{}, alternative{};  ///< specs; empty when nothing is open
  double d{0};                          ///< size of the effect as found, in its standard deviations
  bool assumed{false};                  ///< it was too small to be seen: the smallest that is stands for it
  double p_right_before{0};
  bool none_helps{false};         ///< no measurement of the menu tells them apart better than this run does
  std::vector<NextStep> steps{};  ///< best first; of formulas: by what each adds a minute
  // Where formulas were asked about (next_among.h):
  std::vector<design::Hypothesis> hypotheses{};
  std::optional<double> lambda_before{};
  bool told_apart{false};  ///< by the poses of the run
  std::vector<design::LeftOut> left_out{};
  std::vector<std::pair<std::string, std::string>> never{};  ///< specs that no measurement tells apart
};

/// `pair`: two effects, by name or spec; empty: the verdict's own. Refuses a pair of which one cannot be
/// tested on this run, with what would make it testable.
[[nodiscard]] Result<NextReport> next_of(const PoseTable& table, const ExplainOptions& options,
                                         const std::optional<std::pair<std::string, std::string>>& pair);
/// The same after explain() of that table with those options.
[[nodiscard]] Result<NextReport> next_after(const ExplainReport& explained, const PoseTable& table,
                                            const ExplainOptions& options,
                                            const std::optional<std::pair<std::string, std::string>>& pair);

}  // namespace mgtd::calib::criticism::search
