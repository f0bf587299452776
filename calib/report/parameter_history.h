// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calib/calibration/calibration.h"
#include "calib/report/figures/figure.h"
#include "calib/validity/diff.h"

/// These functions show how the parameters of one array moved from calibration to calibration: as JSON, as
/// text and as a figure.
namespace mgtd::calib::report {

/// What changed from one calibration to the next of the same array.
struct ParameterMoves {
  std::string from, to;  ///< ids
  std::string t_utc;     ///< start of the run that `to` is from
  validity::DiffReport diff;
};
/// Both of one array.
[[nodiscard]] ParameterMoves moves_between(const calibration::Calibration& from,
                                           const calibration::Calibration& to);
/// From each to the next in the order of time. Those whose start is not known and those of another array than
/// the newest are left out.
[[nodiscard]] std::vector<ParameterMoves> moves_among(std::vector<calibration::Calibration> calibrations);

/// {"from","to","t_utc","changed","conclusion","remarks":[..],"text": moves_text,
///  "parameters":[{"name","moved","moved_sd","unit",..}]}: change_report.h says what stands in these.
[[nodiscard]] nlohmann::json to_json(const ParameterMoves& moves);
/// A heading, then for each sensor the parameter of each kind (offset, scale, angle between axes, turn) that
/// moved most in standard errors, with its change and the standard error.
[[nodiscard]] std::string moves_text(const ParameterMoves& moves);
/// Empty where nothing moved from one to another.
[[nodiscard]] std::optional<figures::Figure> history_of(const std::vector<ParameterMoves>& moves);

/// {"name","title","svg","caption","good"}
[[nodiscard]] nlohmann::json to_json(const figures::Figure& figure);

}  // namespace mgtd::calib::report
