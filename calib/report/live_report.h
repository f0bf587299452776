// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "calib/criticism/live/live_finding.h"
#include "calib/criticism/tests/rearrangement.h"

/// A LiveReport says, in words for an operator, what the stream shows of its calibration.
namespace mgtd::calib::report {

struct LiveReport {
  criticism::live::LiveState state{criticism::live::LiveState::none};
  std::string measured{}, limit{}, remedy{};  ///< empty in states none, learning and ok
};

/// `rearranged`, where there is one, comes before `found`: a sensor in another place makes the closure large
/// by itself.
[[nodiscard]] LiveReport live_report(
    const criticism::live::LiveFinding& found,
    const std::optional<criticism::tests::RearrangementFinding>& rearranged = {});

}  // namespace mgtd::calib::report
