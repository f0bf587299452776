// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "tests/rig/scenario.h"

/// This writes the pose table of a scenario to a file, straight from the physics.
namespace mgtd::rig {

struct TableFileOptions {
  std::string output;           ///< empty: standard output
  std::string poses{"run157"};  ///< that, octant157, grid5832, or a list of poses in a file
  bool poses_given{false};      ///< by the person; a recording or a cage says itself which rows there are
  bool samples{false};          ///< sample by sample, instead of the distribution of the means
  double begin_s{0};            ///< of the world's time, when the run starts
};

/// Exit code: 0, or 2 with the reason on stderr.
[[nodiscard]] int write_table_file(const TableFileOptions& options, Scenario scenario);

}  // namespace mgtd::rig
