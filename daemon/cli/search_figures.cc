// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/search_figures.h"

#include "calib/criticism/search/evidence.h"
#include "calib/report/explain_figures.h"

namespace mgtd::daemon::cli {

std::vector<calib::report::figures::Figure> candidate_figures(
    const PoseTable& table, const calib::criticism::search::ExplainOptions& options,
    const calib::criticism::search::ExplainReport& explained) {
  std::vector<calib::report::figures::Figure> out;
  if (explained.candidates.empty()) return out;
  out.push_back(calib::report::candidates_of(explained));
  const auto& best = explained.candidates.front();
  if (const auto evidence =
          calib::criticism::search::evidence_of(table, options, best.effect, best.where, false))
    out.push_back(calib::report::evidence_of(*evidence));
  return out;
}

std::vector<calib::report::figures::Figure> limit_figures(
    const calib::criticism::search::ExplainReport& explained) {
  std::vector<calib::report::figures::Figure> out;
  if (!explained.detectable.empty())
    out.push_back(calib::report::detectable_of(explained.detectable, explained.untestable));
  if (explained.confusion && explained.confusion->effects.size() > 1)
    out.push_back(calib::report::confusion_of(*explained.confusion));
  return out;
}

}  // namespace mgtd::daemon::cli
