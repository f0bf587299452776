// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"

/// A RunJudgement records what the poses of a run said when all that were planned had been measured, and what
/// was done about it. A run that goes on until its residual is explained keeps one for each look, in order,
/// as a document of its file:
///
///   [ {"poses":157,"found":"AMBIGUOUS: ...","next":"24 more poses ...","minutes":12.5}, ... ]
namespace mgtd::daemon::run {

/// Names of the document, and of that with the plan that followed from it, where it grew.
inline constexpr std::string_view kJudgements = "judgements", kExtendedPlan = "extended_plan";
/// Looks at one run: they share the chance that the true name is lost.
inline constexpr int kMostJudgements = 5;

struct RunJudgement {
  int poses{0};       ///< judged
  std::string found;  ///< the verdict, and of what
  std::string next;   ///< what is measured because of it and what that would bring; or why nothing is
  double minutes{0};  ///< that it takes; 0: nothing more is measured
  bool operator==(const RunJudgement&) const = default;
};

[[nodiscard]] nlohmann::json to_json(const std::vector<RunJudgement>& judgements);
/// An empty text: none yet. Refuses what to_json() does not write.
[[nodiscard]] Result<std::vector<RunJudgement>> judgements_from_json(std::string_view text);

}  // namespace mgtd::daemon::run
