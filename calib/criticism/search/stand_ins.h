// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/criticism/search/explain_report.h"

namespace mgtd::calib::criticism::search {

/// take_back_stand_ins() takes back the names of effects that only stand in for a law of no library:
/// `stand_ins`, specs of effects of the report's model that formulas account for without them. The verdict is
/// then UNKNOWN, or PARTIAL where a name remains. Rounds and model stay, since they describe what was tried;
/// `next` is cleared if the first name is taken back.
void take_back_stand_ins(const std::vector<std::string>& stand_ins, ExplainReport& report);

}  // namespace mgtd::calib::criticism::search
