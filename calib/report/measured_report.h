// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "calib/criticism/tests/measured_columns.h"

/// to_json() writes what a run shows by itself where the fit is refused: the readings, the field and the
/// circumstances.
namespace mgtd::calib::report {

/// {"poses": arrays by column, one entry a pose, null: not measured,
///  "panels": [{"name","title","caption","good","stands_out"}], of what was measured: the length of the
///            readings against time and direction, the readings, the field, temperatures, table angles and
///            the spread within the dwells,
///  "less": what "raw_nT" is the length of the readings less of}
[[nodiscard]] nlohmann::json to_json(const criticism::tests::MeasuredColumns& columns);

}  // namespace mgtd::calib::report
