// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "daemon/store/database.h"
#include "daemon/store/run_header.h"

/// These functions create the tables of a run file, write its header as rows of `meta`, and read it back.
namespace mgtd::daemon::store {

inline constexpr int kRunApplicationId = 0x6d677472;  ///< "mgtr", at byte 68 of the file: file(1) can know it
/// 1: the cross of four sensors, which is all that programs before this knew. 2: any other array, its places
/// in `meta` (positions_m), or a reference field (table `reference`). A file has the lowest that holds it.
inline constexpr int kRunSchemaVersion = 2;
inline constexpr int kCrossSchemaVersion = 1;

[[nodiscard]] Result<void> create_run_schema(Database& db, const RunHeader& header);
/// Not a run file, a newer schema, damage: each is refused by name.
[[nodiscard]] Result<RunHeader> check_run_schema(const Database& db, const std::string& file);

}  // namespace mgtd::daemon::store
