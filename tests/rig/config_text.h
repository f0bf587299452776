// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "tests/rig/scenario.h"

/// This writes the mgtd.toml that fits a simulated rig: ports in `dir`, everything the daemon keeps in
/// `state_dir`.
namespace mgtd::rig {

[[nodiscard]] std::string config_text(const Scenario& scenario, const std::string& dir,
                                      const std::string& state_dir, double speed_up, const std::string& tcp);

}  // namespace mgtd::rig
