// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace mgtd::rig {

/// scenario_help() writes the foot of mgt-rig --help: what a scenario file may say, section by section, every
/// effect with its keys, and the exit codes.
[[nodiscard]] std::string scenario_help();

}  // namespace mgtd::rig
