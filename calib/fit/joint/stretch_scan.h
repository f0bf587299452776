// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>

#include "calib/fit/joint/joint_solver.h"
#include "calib/fit/joint/pose_blame.h"

/// shifted_stretch() finds the stretch of consecutive poses in which one sensor, or all of them, read by a
/// constant apart from the rest of the run, by too little for any single pose to show it.
///
/// A scan statistic: for each window of a twentieth to a third of the run, and each set of channels, the
/// score test of a shift of these channels in the window (chi-square with as many degrees of freedom as
/// channels), the fixed block and the pose's own unknowns projected out. The largest one counts where it
/// passes the Bonferroni bound over all windows and sets, and where the shift is several standard deviations
/// of a reading: a small law is the business of explain(). A window at either end of the run is none, since
/// what it differs by may as well be a step. Nor is there one where a sensor whose offset, scale factors and
/// angles changed for good at some pose accounts for more: then a sensor has moved, and its readings are
/// good.
namespace mgtd::calib::fit::joint {

struct ShiftedStretch {
  std::size_t first{0}, last{0};  ///< places of its poses, both included
  Rows rows;                      ///< the readings of one sensor, or of all
  double chi2{0};                 ///< the score test
};

/// Empty where no stretch stands out.
[[nodiscard]] std::optional<ShiftedStretch> shifted_stretch(const JointProblem& problem,
                                                            const JointSolution& solution);

}  // namespace mgtd::calib::fit::joint
