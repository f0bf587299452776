// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string_view>
#include <vector>

#include "calib/effects/effect.h"

/// The effects that can be put in the model by name (`--with`).
namespace mgtd::calib {

using EffectPtr = std::shared_ptr<const Effect>;

/// Names that make_effect knows, in the order they are listed to the user.
[[nodiscard]] std::vector<std::string_view> effect_names();
/// Refuses an unknown name with the list of known ones.
[[nodiscard]] Result<EffectPtr> make_effect(std::string_view name);

}  // namespace mgtd::calib
