// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace mgtd::rig {

/// What a scenario file may say, section by section, every effect with its keys, and the exit codes: the foot
/// of mgt-rig --help.
[[nodiscard]] std::string scenario_help();

}  // namespace mgtd::rig
