// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/calibration/calibration.h"
#include "proto/pose.h"

/// quantisation_of() finds the quantisation step of the readings, that of the digitiser or of the table, from
/// their own grid.
///
/// Where the noise of a sample is small against the step q, all samples of a dwell are the same number, and
/// their mean is off by up to q/2 however many there are: the spread within the dwell says zero. Readings of
/// dwells without spread are multiples of q; the largest q that fits them is the step. Its error is uniform,
/// with variance q^2/12, at the share of the readings that are stuck; a sample that moves by a step or more
/// within its dwell averages it out.
///
/// Means can stand on a grid as well, when they were rounded before they were written down. Then every
/// reading is off by up to q/2, whatever its spread; a step below half the noise of a mean is not looked for.
namespace mgtd::calib::fit {

struct Quantisation {
  double step_nT{0};  ///< 0: no grid is seen
  calibration::AxisNoise variance_nT2{
      calibration::AxisNoise::Zero(kSensors, 3)};  ///< of a pose mean, by axis
  [[nodiscard]] bool seen() const { return step_nT > 0; }
};

/// Poses of set "check" take part. Nothing is seen where spreads are not recorded.
[[nodiscard]] Quantisation quantisation_of(const PoseTable& table);

}  // namespace mgtd::calib::fit
