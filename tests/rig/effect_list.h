// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "tests/rig/effect.h"
#include "tests/rig/section.h"

/// Every effect the rig can hide, by name, with the keys it reads.
namespace mgtd::rig {

/// Reads one [[effect]] of a scenario. Null, with the mistake noted in the section, when it is none.
[[nodiscard]] std::shared_ptr<const Effect> read_effect(Section& section);

/// "axis.cubic  where nT_at_F0" and so on, for the help.
[[nodiscard]] std::vector<std::string> effect_help();

}  // namespace mgtd::rig
