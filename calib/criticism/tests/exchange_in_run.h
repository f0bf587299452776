// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "calib/calibration/calibration.h"
#include "calib/criticism/tests/rearrangement.h"
#include "proto/pose.h"

/// exchange_in_run() and exchanged_since() find sensors whose plugs changed places: within a run, from a pose
/// on, or between an earlier calibration and a new one.
///
/// Within a run, by the total field that each sensor saw, which needs no angles and no mounting:
///
///     y' Q y + u' y = (f/F)^2        nine numbers a sensor, linear least squares
///
/// For every pose to begin with and every exchange, sensor i before it and sensor j from it on are fitted as
/// one sensor. An exchange is concluded when it fits the four at least kBetter times closer than no exchange
/// and twice closer than any other one, and the fit without exchange is off by more than kLeast_nT.
///
/// Does not see an exchange of all poses (the second question does), of sensors that are alike to some nT,
/// nor one that was undone within the run.
namespace mgtd::calib::criticism::tests {

struct ExchangeInRun {
  Rearrangement what;
  int from_pose{0};                      ///< number of the first pose after it
  double residual_nT{0}, without_nT{0};  ///< of the total field, rms over sensors: taken so, and as it stands
};

/// `field_nT`: of poses that have no f_nT; where there is none either, the field is taken as constant.
[[nodiscard]] std::optional<ExchangeInRun> exchange_in_run(const PoseTable& table,
                                                           std::optional<double> field_nT);

/// Sensors of `now` that have each other's scales, angles between axes and offsets of `before`: those that
/// come within ageing (10 nT, 2e-4 of scale and angle) of another one's and are ten times that from their
/// own.
[[nodiscard]] std::optional<Rearrangement> exchanged_since(const calibration::Calibration& before,
                                                           const calibration::Calibration& now);

}  // namespace mgtd::calib::criticism::tests
