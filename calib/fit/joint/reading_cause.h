// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/fit/joint/joint_problem.h"

/// Finds from the digits alone why a reading contradicts the others (saturated, stuck): a mean over a dwell
/// never repeats by chance.
namespace mgtd::calib::fit::joint {

/// Poses in which this channel reads its largest, or its smallest, value, where three or more share it to the
/// last digit: the end of the digitiser's range, or of the feedback. Where the two ends differ in sign alone
/// they count together.
[[nodiscard]] std::vector<std::size_t> at_the_stop(const JointProblem& problem, int channel);

/// "saturated", "stuck" (the same value as in the pose before or after), or empty.
[[nodiscard]] std::string cause_of(const JointProblem& problem, std::size_t pose, int channel);

}  // namespace mgtd::calib::fit::joint
