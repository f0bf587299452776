// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tests/blind/planted.h"
#include "tests/blind/real_draw.h"
#include "tests/blind/real_kind.h"

/// This makes a kind of run from the plain rig and one change of it. Each run is made twice, with the change
/// and without it.
namespace mgtd::calib::testing {

/// Changes what the plain rig is; `plain` is its run, for the times of the poses.
using Change = std::function<void(Stage&, const PoseTable& plain, Random&)>;
/// The poses of both runs.
using Poses = rig::Design (*)(const rig::Scenario&, std::uint64_t seed);

[[nodiscard]] rig::Design usual_poses(const rig::Scenario& scenario, std::uint64_t seed);

/// The other arguments are the members of RealKind.
[[nodiscard]] RealKind rig_kind(std::string name, std::string what, Must must, std::vector<std::string> right,
                                bool parameters, const Change& change, Poses poses = &usual_poses);

}  // namespace mgtd::calib::testing
