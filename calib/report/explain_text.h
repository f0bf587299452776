// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/criticism/search/explain_report.h"
#include "calib/report/seen_width.h"

namespace mgtd::calib::report {

/// to_text() writes what explain() found for the terminal: verdict, table of candidates, what could have been
/// seen, what these poses cannot tell. Where `width` has no room for the whole table of candidates, a short
/// one has name and place in one column.
[[nodiscard]] std::string to_text(const criticism::search::ExplainReport& report,
                                  std::size_t width = kAnyWidth);

}  // namespace mgtd::calib::report
