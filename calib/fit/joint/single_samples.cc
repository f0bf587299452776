// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/single_samples.h"

#include <algorithm>

namespace mgtd::calib::fit::joint {

bool is_recording(const JointProblem& problem) {
  return problem.poses.size() >= kRecording &&
         std::none_of(problem.poses.begin(), problem.poses.end(),
                      [](const JointPose& p) { return p.pose->n || p.pose->n_eff; });
}

bool reads_single_samples(const JointProblem& problem) {
  return problem.sensors() == 1 || is_recording(problem);
}

}  // namespace mgtd::calib::fit::joint
