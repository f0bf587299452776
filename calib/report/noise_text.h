// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/criticism/tests/noise.h"

namespace mgtd::calib::report {

/// noise_of_tests() says what the tests take for noise when it is not what the dwells say, and why; else it
/// is empty.
[[nodiscard]] std::string noise_of_tests(const criticism::tests::NoiseModel& noise);

}  // namespace mgtd::calib::report
