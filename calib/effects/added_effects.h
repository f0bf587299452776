// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "calib/effects/effect.h"

namespace mgtd::calib::effects {

/// added_effects() tells which effects of a model a search has added to those that it was given. A search may
/// replace one that was given, and then the first of the model are not those that were given: an effect is
/// told by its spec.
[[nodiscard]] std::vector<EffectPtr> added_effects(std::span<const EffectPtr> model,
                                                   std::span<const EffectPtr> given);

}  // namespace mgtd::calib::effects
