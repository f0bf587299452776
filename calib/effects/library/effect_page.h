// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "calib/effects/library/effect_family.h"

/// These functions write the library of effects as an operator reads it.
namespace mgtd::calib::effects::library {

/// One line for each effect, by level.
[[nodiscard]] std::string effect_list();
/// Everything that is known of one effect.
[[nodiscard]] std::string effect_page(const EffectFamily& family);
/// {"schema":"mgt.effects/1", "effects":[...]}, of all or of one.
[[nodiscard]] nlohmann::json effects_json(std::span<const EffectFamily> families);

}  // namespace mgtd::calib::effects::library
