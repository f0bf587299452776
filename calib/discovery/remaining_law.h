// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "calib/discovery/discover.h"
#include "calib/effects/effect.h"

/// remaining_law() looks for the formula of what the effects of the library leave unexplained.
///
/// Effects that describe a part may stand in for a law of no library. So it is looked for first without them:
/// where formulas account for everything, an effect keeps its name only if one of these laws is that effect,
/// as far as their evidence can tell, and if there are fewer formulas with it in the model. Where formulas
/// alone leave anything, they are looked for beside all effects.
namespace mgtd::calib::discovery {

struct RemainingLaw {
  Result<DiscoveryReport> found;
  std::vector<effects::EffectPtr> model;  ///< that was searched beside
  /// Specs of effects that describe a part, which formulas account for without them.
  std::vector<std::string> instead_of{};
};

/// `described`: the model of `options`, then the effects that a search has added to it. Refuses nothing: what
/// discover() refuses stands in `found`.
[[nodiscard]] RemainingLaw remaining_law(const PoseTable& table, const DiscoverOptions& options,
                                         const std::vector<effects::EffectPtr>& described);

/// The same, but empty where formulas take the place of no effect.
[[nodiscard]] std::optional<RemainingLaw> law_instead(const PoseTable& table, const DiscoverOptions& options,
                                                      const std::vector<effects::EffectPtr>& described);

}  // namespace mgtd::calib::discovery
