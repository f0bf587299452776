// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "calib/poses/import_map.h"
#include "proto/error.h"

/// import_table() turns a foreign table (any delimiter, units, order and signs) into the text of a pose table
/// (pose_table.h). Poses are numbered from 1. Every row that is taken stands in the line that it has in the
/// file (one line later where the file has no header), so that what is refused later is named by its line;
/// lines that are not taken are empty.
namespace mgtd::calib::poses {

/// Cells may stand in double quotes. Refuses, with file:line:column and what to do: a column that is not
/// there (the error lists those that are) or there twice, a row of another length, text where a number
/// belongs, a time that cannot be read or goes back, text in UTF-16, and a file without rows. An empty cell
/// stays empty. Does not judge whether the values make sense: parse_pose_table does.
[[nodiscard]] Result<std::string> import_table(std::string_view text, std::string_view file,
                                               const ImportMap& map);

}  // namespace mgtd::calib::poses
