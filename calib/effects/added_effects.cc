// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/added_effects.h"

#include <algorithm>
#include <iterator>
#include <string>

namespace mgtd::calib::effects {

std::vector<EffectPtr> added_effects(std::span<const EffectPtr> model, std::span<const EffectPtr> given) {
  const std::vector<std::string> before = specs_of(given);
  std::vector<EffectPtr> out;
  std::copy_if(model.begin(), model.end(), std::back_inserter(out), [&](const EffectPtr& effect) {
    return std::find(before.begin(), before.end(), effect->spec()) == before.end();
  });
  return out;
}

}  // namespace mgtd::calib::effects
