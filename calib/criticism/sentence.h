// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/criticism/explain.h"

namespace mgtd::calib {

/// The verdict as one paragraph for a person, made of the report's figures and nothing else.
[[nodiscard]] std::string sentence(const ExplainReport& report);

/// "+0.42 +- 0.03 nT/degC", for several coefficients the largest against its uncertainty.
[[nodiscard]] std::string size_text(const Candidate& candidate);

}  // namespace mgtd::calib
