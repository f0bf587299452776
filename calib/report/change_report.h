// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "calib/report/seen_width.h"
#include "calib/validity/change.h"

/// These functions write a change of the calibration as a JSON object and as text for a person.
namespace mgtd::calib::report {

/// {"chi2","dof","log10_p","log10_p_single","p","sensors":[...],"named":[...],"parameters":[...]}; angles in
/// degrees, each parameter with its unit; `change` as if it alone had changed, `moved` as it differs.
[[nodiscard]] nlohmann::json to_json(const validity::Change& change);

/// "s3 iz +7.9 nT (8.1 sigma), s1 cx ..."
[[nodiscard]] std::string named_text(const validity::Change& change);
/// "p = 0.32; chi-square 41.0 for 45 directions"
[[nodiscard]] std::string figures_text(const validity::Change& change);
/// By sensor whether its change alone would do, then the `rows` parameters that differ most.
[[nodiscard]] std::string change_table(const validity::Change& change, std::size_t rows,
                                       std::size_t width = kAnyWidth);
/// "turn of the whole array, which is no change of its calibration: -0.5000 ± 0.0002, ... deg about X, Y, Z"
[[nodiscard]] std::string turn_text(const validity::CommonTurn& turn);
/// Smallest change that would be found in 80 of 100 cases, worst over the sensors, by kind of parameter.
[[nodiscard]] std::string seen_text(const validity::Change& change);

}  // namespace mgtd::calib::report
