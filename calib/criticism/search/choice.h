// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/criticism/search/explain_report.h"

/// A Choice records what the poses said of an effect when it was added to a model: which others could have
/// stood in its place, and whether it was all that stood out. A fit with the effect in it no longer shows
/// either, so the record is kept with the effect until other data settle it.
///
///     an alternative is dropped   when on other data the model with it in the place of the effect leaves
///                                 more, by more than chance: dof ln(ratio of chi-square per dof) above
///                                 2 ln 1000
///     `describes` is cleared      when on other data nothing stands out beside the model
namespace mgtd::calib::criticism::search {

struct Choice {
  std::string spec{};     ///< of the effect, with the numbers that were searched
  std::string finding{};  ///< the verdict at the time
  std::vector<std::string>
      alternatives{};     ///< specs of those that could stand in its place; numbers left open
  bool describes{false};  ///< it was one of several surrogates, or beside something unknown
  std::string data{};     ///< hash of the poses that said so

  [[nodiscard]] bool open() const { return describes || !alternatives.empty(); }
};

/// Of an effect that is about to be added. `before`: what was said of the model without it.
[[nodiscard]] Choice choice_of(const ExplainReport& before, const PoseTable& table,
                               const effects::EffectPtr& effect);

/// What is left of the doubt on these poses. `options`: the model, with the effect in it. The same poses
/// leave it as it was. An alternative that cannot be fitted here stays.
[[nodiscard]] Choice on_these_poses(Choice choice, const PoseTable& table, const fit::FitOptions& options);

}  // namespace mgtd::calib::criticism::search
