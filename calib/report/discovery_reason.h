// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "calib/discovery/discovery_report.h"

/// These functions say why discover() came to its finding: which rule decided, what was measured against
/// which limit, and what can be done about it.
namespace mgtd::calib::report {

/// The random offset that walks and stands against a law: "an offset that walks at s3.z".
[[nodiscard]] std::string walk_text(const discovery::FoundLaw& law);

/// "random-beside", as JSON names the rule; "none" of a LAW.
[[nodiscard]] std::string_view rule_name(discovery::LawFindingReason::Rule rule);
/// One sentence; empty where no rule kept the finding from being LAW.
[[nodiscard]] std::string reason_text(const discovery::DiscoveryReport& report);
/// What a person does next. `run` as the person typed it; `kept`: names under which it keeps the formulas
/// already.
[[nodiscard]] std::string what_next(const discovery::DiscoveryReport& report, const std::string& run,
                                    const std::vector<std::string>& kept = {});

}  // namespace mgtd::calib::report
