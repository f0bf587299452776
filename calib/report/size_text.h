// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/criticism/tests/candidate.h"

namespace mgtd::calib::report {

/// size_text() writes the size of an effect with its standard deviation, "+0.42 +- 0.03 nT/degC"; of several
/// coefficients it takes the one that stands out most from its uncertainty.
[[nodiscard]] std::string size_text(const criticism::tests::Candidate& candidate);

}  // namespace mgtd::calib::report
