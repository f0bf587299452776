// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/fit/joint/joint_fit.h"

/// pose_influences() says how much of a calibration hangs on each single pose.
///
/// With S the information of the fixed block and S_k, g_k the shares of pose k in it and in the descent
/// direction, the nuisances of the pose eliminated,
///     leverage   tr(S_k S^-1) / n_k,  n_k the observations of the pose less its own nuisances: 0 where the
///                other poses tell everything, 1 where this pose alone does
///     shift      dp = -(S - S_k)^-1 g_k, the step of the 12 parameters a sensor that leaving the pose out
///                would make, to first order, as it shows in the tensor of a uniform field of the run's
///                strength: root mean square over all attitudes, the component that moves most
/// The noise and the observations that the fit left out stay as they are. A pose without which something is
/// not determined has a shift of NaN.
namespace mgtd::calib::fit::joint {

struct PoseInfluence {
  double leverage{0};
  double tensor_shift_nT_per_m{0};
  std::string component{};  ///< "xx", ...; empty where no component can be told
};

/// By place in the problem.
[[nodiscard]] Result<std::vector<PoseInfluence>> pose_influences(const JointFit& fit);

}  // namespace mgtd::calib::fit::joint
