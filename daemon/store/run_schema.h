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
/// What to do about a damaged file. `sqlite3 FILE .recover` is not compiled into every sqlite3, .dump is; it
/// leaves out the two numbers by which a run file is known, and ends with ROLLBACK when it met damage.
[[nodiscard]] std::string rescue_remedy(const std::string& file);
/// Not a run file, a newer schema, damage: each is refused by name.
[[nodiscard]] Result<RunHeader> check_run_schema(const Database& db, const std::string& file);

}  // namespace mgtd::daemon::store
