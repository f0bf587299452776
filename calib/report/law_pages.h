// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calib/report/figures/figure.h"
#include "proto/error.h"

/// A LawPage holds what a report says of one law that discover() found on a run. It is read from the object
/// that discovery_report.h makes, so that a report shows what was found then.
namespace mgtd::calib::report {

struct LawPage {
  std::string title{};                     ///< the word and the formula
  figures::DataTable formulas{};           ///< of the 99 % set
  std::optional<figures::Figure> curve{};  ///< where the law depends on one quantity
  std::vector<std::string> notes{};        ///< sentences
};

/// A page for each law that stands out from noise. Refuses an object that is none of mgt.discover/1.
[[nodiscard]] Result<std::vector<LawPage>> law_pages(const nlohmann::json& discovery);

}  // namespace mgtd::calib::report
