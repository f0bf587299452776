// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "calib/criticism/tests/candidate_effect.h"
#include "calib/fit/fit_options.h"

namespace mgtd::calib::criticism::search {

/// ExplainOptions tells explain() which model to examine, and which candidates to test beside or instead of
/// the library.
struct ExplainOptions {
  fit::FitOptions fit;  ///< method joint; its effects are the model that is asked about
  int rounds{4};
  /// Judgements of one run, as it grows, of which this is one: together they lose the true name as seldom as
  /// one alone (tests/alternatives.h).
  int looks{1};
  /// Candidates instead of the library.
  std::optional<std::vector<tests::CandidateEffect>> candidate_effects{};
  /// Candidates beside the library: formulas of the user.
  std::vector<tests::CandidateEffect> also{};
  bool confusion{false};  ///< tell which effects look alike on this run
  bool impact{false};     ///< tell what ignoring each candidate would do to the tensor
};

}  // namespace mgtd::calib::criticism::search
