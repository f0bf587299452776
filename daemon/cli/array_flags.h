// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <CLI/CLI.hpp>
#include <cstddef>
#include <optional>
#include <string>

#include "calib/sensor/geometry.h"
#include "proto/error.h"

/// The options --baseline and --array say where the sensors stand. Without either, what the run file says
/// counts; then the cross for four sensors, and the origin for one. The places of any other array must be
/// given.
namespace mgtd::daemon::cli {

struct ArrayFlags {
  std::optional<double> baseline_m;  ///< of the cross
  std::string array;                 ///< file (daemon/config/array_places.h)
};

void add_array_flags(CLI::App* command, ArrayFlags& flags);

/// What the flags alone say; empty without any.
[[nodiscard]] Result<std::optional<calib::sensor::Geometry>> array_of(const ArrayFlags& flags);

/// For readings of `sensors` sensors in `table`; `kept` is of its run file. Refuses places of another number
/// of sensors, and an array whose places nobody told.
[[nodiscard]] Result<calib::sensor::Geometry> array_for(const ArrayFlags& flags, std::size_t sensors,
                                                        const std::string& table,
                                                        const std::optional<calib::sensor::Geometry>& kept);

}  // namespace mgtd::daemon::cli
