// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/criticism/search/explain_report.h"

namespace mgtd::calib::report {

/// For the terminal: verdict, table of candidates, what could have been seen, what these poses cannot tell.
[[nodiscard]] std::string to_text(const criticism::search::ExplainReport& report);

}  // namespace mgtd::calib::report
