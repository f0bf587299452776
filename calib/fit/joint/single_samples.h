// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>

#include "calib/fit/joint/joint_problem.h"

namespace mgtd::calib::fit::joint {

/// Poses are taken as a recording of single samples when there are at least this many and none says how many
/// samples it is the mean of.
inline constexpr std::size_t kRecording = 300;

/// Whether the poses that are fitted are the samples of a recording.
[[nodiscard]] bool is_recording(const JointProblem& problem);

/// Whether the noise of a reading counts where the reading itself is what a law is a function of: in a
/// recording, and with one sensor, whose reading is all that tells the field of its pose.
[[nodiscard]] bool reads_single_samples(const JointProblem& problem);

}  // namespace mgtd::calib::fit::joint
