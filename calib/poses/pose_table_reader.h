// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "calib/poses/pose_columns.h"
#include "calib/poses/table_text.h"
#include "proto/error.h"
#include "proto/pose.h"

/// A PoseTableReader reads the text of one pose table or pose list from top to bottom and knows where it is
/// for every complaint. What it accepts and refuses stands with parse_pose_table() and parse_pose_list()
/// (pose_table.h), which are the way to use it.
namespace mgtd::calib::poses {

class PoseTableReader {
 public:
  /// What every row must have: readings, or the attitude at which they will be taken.
  enum class Rows { measured, planned };

  /// `sensors`: of the array for which poses are planned; a measured table tells its own. `map`: the file
  /// that names the columns of an imported table. The texts must outlive the reader.
  PoseTableReader(std::string_view text, std::string_view file, Rows rows, std::size_t sensors,
                  std::string_view map = {});

  /// The whole table; called once.
  [[nodiscard]] Result<PoseTable> read();
  /// Where each pose stands.
  [[nodiscard]] const std::vector<int>& lines() const { return lines_; }
  /// Of a list: what a hand has to do before each pose.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  bool next_line();
  Result<void> read_header();
  Result<void> count_sensors(const std::vector<TableCell>& header);
  Result<void> refuse_missing();
  Result<void> refuse_part_of_reference(const Pose& pose, const std::vector<TableCell>& cells);
  Result<Pose> read_row(const std::vector<TableCell>& cells);
  Result<void> read_names(Pose& pose, const std::vector<TableCell>& cells);

  [[nodiscard]] tl::unexpected<Error> complain(std::size_t column, std::string message,
                                               std::string remedy) const;
  [[nodiscard]] std::string remedy_of_missing() const;
  [[nodiscard]] PoseColumn::Limits limits_of(const PoseColumn& column) const;
  [[nodiscard]] std::size_t column_of(std::string_view name) const;
  [[nodiscard]] bool is_note(std::string_view name) const { return rows_ == Rows::planned && name == "note"; }
  [[nodiscard]] bool required(const PoseColumn* column) const;

  std::string_view text_, file_, map_, line_;
  bool header_read_{false};
  Rows rows_;
  std::size_t sensors_;
  bool with_reference_{false};
  std::size_t line_number_{0};
  std::vector<int> lines_;
  std::vector<std::string> notes_;  ///< beside lines_
  std::string note_;                ///< of the row under way
  std::vector<std::string> names_;
  std::vector<const PoseColumn*> known_;  ///< beside names_; null: not one of pose_columns()
};

}  // namespace mgtd::calib::poses
