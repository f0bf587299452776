// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"

/// An ImportMap says which columns of a foreign table become which columns of a pose table, and how they are
/// scaled:
///
///     value = scale * cell + offset
///
/// Unit and sign are part of the scale. The file a map is written in: docs/import.md.
namespace mgtd::calib::poses {

struct ImportedColumn {
  std::string to;    ///< "s1_x_nT", "f_nT", or a name of the user's own, which is a covariate
  std::string from;  ///< its name in the header, or its number from 1 where there is no header
  double scale{1}, offset{0};
};

/// When a row was measured: by a column, or by the number of the row.
struct ImportedTime {
  std::string from;                 ///< empty: rows are at equal intervals
  double unit_s{1};                 ///< of a number; t_s counts from the first row
  bool utc{false};                  ///< the cell is a date, as parse_utc reads it
  std::optional<double> rate_hz{};  ///< of the rows where no column tells the time
};

struct ImportMap {
  /// ' ' stands for any run of blanks; none: the one that the first line has.
  std::optional<char> delimiter{};
  bool header{true};
  int skip{0};  ///< lines before the header, or before the first row
  std::string comment{"#"};
  char decimal{'.'};
  int every{1};       ///< one row of so many is taken
  std::string set{};  ///< word for the column `set`; empty: none
  std::vector<ImportedColumn> columns{};
  std::optional<ImportedTime> time{};
};

/// What a cell in `unit` is multiplied by, and what is added, to stand in the column `to`, whose own unit is
/// the end of its name (_nT, _deg, _degC, _s, _A, _V). Refuses a unit that is no such quantity, with those
/// that are.
struct UnitStep {
  double scale{1}, offset{0};
};
[[nodiscard]] Result<UnitStep> unit_step(std::string_view to, std::string_view unit);

}  // namespace mgtd::calib::poses
