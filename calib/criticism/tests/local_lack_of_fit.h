// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/criticism/tests/criticism.h"

/// local_lack_of_fit_log10_p() tests the residual that a named law leaves on its own axes. Once a law is
/// named, the question is no longer whether anything is wrong anywhere but whether this law is all there is
/// where it acts: a wrong law that is similar leaves its difference from the right one just there. Few
/// questions are asked, so that the difference shows even when it is too small for an alarm.
namespace mgtd::calib::criticism::tests {

/// Probability that effects which are named rightly, one or several, are still reported as incomplete.
inline constexpr double kLackOfFitAlarm = 0.01;

/// log10 of the probability that noise alone leaves so much on `where` ("s3.z" or "s3"), named effects and
/// maps counted; 0 for what acts on more than one sensor.
[[nodiscard]] double local_lack_of_fit_log10_p(const Criticism& criticism, const std::string& where);

}  // namespace mgtd::calib::criticism::tests
