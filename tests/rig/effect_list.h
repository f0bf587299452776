// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "tests/rig/effect.h"
#include "tests/rig/effect_kind.h"
#include "tests/rig/section.h"

/// This lists every effect the rig can hide, by name, with the keys it reads.
namespace mgtd::rig {

/// Reads one [[effect]] of a scenario. Null, with the mistake noted in the section, when it is none.
[[nodiscard]] std::shared_ptr<const Effect> read_effect(Section& section);

/// The same from the lines of one: "name = 'axis.cubic'\nwhere = 's2.x'\nnT_at_F0 = 12".
[[nodiscard]] tl::expected<std::shared_ptr<const Effect>, std::string> effect_of(
    std::string_view toml, std::size_t sensors = kCross);

/// Such lines at random: `size` times the typical size of each coefficient, either sign, somewhere its scope
/// allows; `of` where a covariate is needed.
[[nodiscard]] std::string random_effect(const EffectKind& kind, double size, std::mt19937_64& random,
                                        std::string_view of = "motor_A", std::size_t sensors = kCross);

/// "axis.cubic  where nT_at_F0" and so on, for the help.
[[nodiscard]] std::vector<std::string> effect_help();

}  // namespace mgtd::rig
