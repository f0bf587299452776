// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "calib/criticism/search/explain_options.h"
#include "calib/criticism/tests/added_variable.h"
#include "calib/criticism/tests/candidate.h"
#include "calib/criticism/tests/residual_columns.h"
#include "calib/criticism/tests/residual_maps.h"

/// Evidence holds what speaks for one effect that a model may lack: the poses that show it, what the fit
/// leaves without and with it, what else could stand in its place, and what would tell them apart.
namespace mgtd::calib::criticism::search {

/// What a fit leaves.
struct Left {
  double residual_nT{0}, noise_nT{0}, chi2{0}, dof{0};
  std::vector<tests::MapScore> maps{};  ///< strongest first
  std::optional<tests::ResidualColumns> by_pose{};
  std::shared_ptr<const fit::joint::JointFit> fit{};  ///< points into the pose table
};

struct Evidence {
  tests::Candidate candidate{};
  bool in_model{false};  ///< it was in the model, and `before` is without it
  tests::AddedVariable added;
  Left before, after;
  /// How the effect differs from others that look alike, by the library; empty for a formula.
  struct Tell {
    std::string effect{}, by{};
  };
  std::vector<Tell> tells{};
};

/// `effect`: NAME or NAME@WHERE; `at`: where it acts, instead of where it shows best. An effect of the model
/// is taken out of it first. Refuses an unknown effect, one that these poses cannot test, and a place that it
/// cannot have.
[[nodiscard]] Result<Evidence> evidence_of(const PoseTable& table, const ExplainOptions& options,
                                           const std::string& effect, const std::string& at, bool by_pose);

}  // namespace mgtd::calib::criticism::search
