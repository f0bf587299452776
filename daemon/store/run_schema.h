// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "daemon/store/database.h"
#include "daemon/store/run_header.h"

/// This creates the tables of a run file, and writes its header as rows of `meta`.
namespace mgtd::daemon::store {

inline constexpr int kRunApplicationId = 0x6d677472;  ///< "mgtr", at byte 68 of the file: file(1) can know it
inline constexpr int kRunSchemaVersion = 1;

[[nodiscard]] Result<void> create_run_schema(Database& db, const RunHeader& header);
/// Not a run file, a newer schema, damage: each is refused by name.
[[nodiscard]] Result<RunHeader> check_run_schema(const Database& db, const std::string& file);

}  // namespace mgtd::daemon::store
