// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "calib/criticism/search/explain_report.h"

namespace mgtd::calib::report {

/// sentence() writes the verdict of explain() as one paragraph for a person, made of the report's figures and
/// nothing else.
[[nodiscard]] std::string sentence(const criticism::search::ExplainReport& report);

/// The names of the verdict: "A, B"; where another effect could stand in the place of one, "A; B or C".
[[nodiscard]] std::string names_text(const criticism::search::ExplainReport& report);

/// "0.14 nT (s3.z)"; in words where no size would be seen.
[[nodiscard]] std::string detectable_text(const criticism::tests::Detectable& detectable);

/// A clause with a capital letter and a full stop. A first word with a dot or a digit in it is a name and
/// stays.
[[nodiscard]] std::string as_sentence(std::string clause);

/// What the share of a candidate is a share of.
[[nodiscard]] std::string_view share_of(const criticism::search::ExplainReport& report);

}  // namespace mgtd::calib::report
