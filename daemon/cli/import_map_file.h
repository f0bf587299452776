// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "calib/poses/import_map.h"
#include "proto/error.h"

/// `mgt import --columns` reads a TOML file that says which columns of a file of readings become which
/// columns of the pose table (ImportMap).
///
///     [columns]                       # of the pose table, each from a column of the file
///     s1_x_nT = {from = "mag_x", unit = "uT", sign = -1}
///     s1_T_degC = {from = "temp", scale = 0.01, offset = -40}
///     battery_V = "v_batt"            # as it is
///     [time]                          # absent: the rows have no time
///     from = "stamp"                  # absent: rows at equal intervals, `rate_hz` a second
///     unit = "ms"                     # s (default), ms, us, ns, min, h, or utc: 2026-11-21T10:00:00Z
///     [file]                          # absent: a header, and the delimiter that the first line has
///     delimiter = ";"                 # one character, "tab", or "blanks"
///     header = false                  # columns are called "1", "2", ...
///     skip = 3                        # lines before the header
///     comment = "#"
///     decimal = ","
///     every = 10                      # take one row of ten
///     set = "random"
namespace mgtd::daemon::cli {

/// Refuses what is not TOML, unknown keys (naming the nearest known one) and values that cannot be, all at
/// once, one a line: file:line:column.
[[nodiscard]] Result<calib::poses::ImportMap> import_map_from_text(std::string_view text,
                                                                   const std::string& file);

}  // namespace mgtd::daemon::cli
