// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/fit/joint/joint_problem.h"
#include "calib/fit/outlier_node.h"

/// These functions find why readings contradict the others: from the digits alone (saturated, stuck), since a
/// mean over a dwell never repeats by chance, and from where in the run they stand (a source that came and
/// went).
namespace mgtd::calib::fit::joint {

/// Poses in which this channel reads its largest, or its smallest, value, where three or more share it to the
/// last digit: the end of the digitiser's range, or of the feedback. Where the two ends differ in sign alone
/// they count together.
[[nodiscard]] std::vector<std::size_t> at_the_stop(const JointProblem& problem, int channel);

/// "saturated" (at the stop, or alone at an end of its channel without any scatter in its dwell), "stuck"
/// (the same value as in the pose before or after), or empty.
[[nodiscard]] std::string cause_of(const JointProblem& problem, std::size_t pose, int channel);

/// "a source that came and went", for whole poses without another cause, three or more in a row, where the
/// run of that many `poses` goes on undisturbed before and after them. A stretch at either end of the run may
/// as well be a step of the site, and gets no cause.
void tell_passing_sources(std::vector<OutlierNode>& nodes, std::size_t poses);

}  // namespace mgtd::calib::fit::joint
