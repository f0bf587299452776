// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "proto/error.h"
#include "proto/pose.h"

/// These functions read and write the pose table as text (CSV, '.' decimal point, header row, empty cell =
/// not measured). Columns are described in docs/pose-table.md. The readings s1_x_nT ... tell how many sensors
/// there are, 1 to kMostSensors; they are required, and every other column is optional. A numeric column with
/// a name of its own is a covariate.
namespace mgtd::calib::poses {

/// Tolerates any end of line, a byte order mark, blank lines, '#' comments, cells in double quotes and spaces
/// around cells. Refuses, with
/// file:line:column and what to do: a missing column, a gap in the numbers of the sensors, a column named
/// twice, a row of another length, text where a number belongs, nan, inf, a number that cannot be
/// (PoseColumn::limits), an unreadable time, a pose number twice, a reference field without all three
/// components, a table without a row. `file` is for the messages; `map` as well: the file that names the
/// columns of an imported table, whose header nobody wrote.
[[nodiscard]] Result<PoseTable> parse_pose_table(std::string_view text, std::string_view file,
                                                 std::string_view map = {});

/// The same of poses that are still to be measured: the three angles are required, readings are not looked
/// for. `sensors`: of the array; a column of any further sensor is refused.
[[nodiscard]] Result<PoseTable> parse_pose_list(std::string_view text, std::string_view file,
                                                std::size_t sensors = kSensorCount);

/// Every number in the shortest form that reads back to the same bits; columns nobody filled are left out.
[[nodiscard]] std::string format_pose_table(const PoseTable& table);

/// SHA-256 of the canonical text: what a calibration was fitted to.
[[nodiscard]] std::string data_hash(const PoseTable& table);

}  // namespace mgtd::calib::poses
