// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/calibration/calibration.h"
#include "proto/error.h"

/// validate() checks whether a calibration that came from elsewhere can be used on readings.
namespace mgtd::calib::validity {

/// Refuses, with what was found and the limit: a method that does not exist; a scale outside 0.1 to 10 or a
/// non-orthogonality of 60 deg and more (the reading could not be turned into a field); a mounting that is no
/// signed permutation; noise below zero; a number of coefficients or a shape of their covariance that the
/// effects do not have; a covariance that is none (least eigenvalue of its correlation below -1e-6); a start
/// that is no time. What the text form cannot hold (not a number, infinite) never comes here, nor does a
/// content that differs from its id. Says nothing of how good the calibration is: its checks do.
[[nodiscard]] Result<void> validate(const calibration::Calibration& calibration);

}  // namespace mgtd::calib::validity
