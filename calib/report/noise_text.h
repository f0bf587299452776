// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/criticism/tests/noise.h"

namespace mgtd::calib::report {

/// What the tests take for noise instead, and why; empty where they take what the dwells say.
[[nodiscard]] std::string noise_of_tests(const criticism::tests::NoiseModel& noise);

}  // namespace mgtd::calib::report
