// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/fit/outlier_node.h"
#include "calib/fit/readings.h"
#include "calib/fit/two_step/two_step.h"

/// agreeing_readings() chooses the poses that the two-step method is given: where the readings look spoilt,
/// those that agree with each other (consensus.h). It leaves out whole poses, whatever of them is wrong.
namespace mgtd::calib::fit::two_step {

struct AgreeingReadings {
  Readings kept;
  std::vector<Eigen::Index> left_out;
};
[[nodiscard]] AgreeingReadings agreeing_readings(const Readings& readings);

/// What of the poses left out contradicts a calibration: the sensor that the others contradict, or the
/// pose.
[[nodiscard]] std::vector<OutlierNode> left_out_nodes(const Readings& readings,
                                                      const AgreeingReadings& agreeing,
                                                      const TwoStep& fitted);

}  // namespace mgtd::calib::fit::two_step
