// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "calib/criticism/tests/residual_columns.h"

namespace mgtd::calib::report {

/// to_json() writes what a fit leaves at each pose as the key "poses" of "mgt.compare/1": arrays by column,
/// one entry a pose. null: not known, or left out.
[[nodiscard]] nlohmann::json to_json(const criticism::tests::ResidualColumns& columns);
/// The same as CSV, one row a pose, numbers that read back as they are. Empty cells: as null.
[[nodiscard]] std::string to_csv(const criticism::tests::ResidualColumns& columns);

}  // namespace mgtd::calib::report
