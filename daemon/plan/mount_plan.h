// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "daemon/plan/run_plan.h"

/// A table that turns about one axis sees every direction of the field only when the array is put on it in
/// other ways: re-mountings by hand alternate with azimuths that are driven.
///
/// The standard set belongs to the first mounting (level, by default). The random poses are shared out to the
/// mountings and, last, to the first one put on once more, so that what changed with time shows; in each of
/// them azimuths evenly over the travel in random order, some visited twice, dwell and sense at random.
namespace mgtd::daemon::plan {

/// Level, and on each of its four sides.
[[nodiscard]] std::vector<TableAngles> usual_mounts();

/// Adds the random set of `plan.options.mounts`, and numbers the mountings of the standard set.
void add_mounts(RunPlan& plan, const drivers::TableLimits& limits);
/// Says how often the operator is asked.
void note_mounts(RunPlan& plan);

/// "roll 90 deg", "level".
[[nodiscard]] std::string mounting_in_words(const TableAngles& mounting);
/// Reads that: "level", or axis and degrees, one or several: "pitch -90", "pitch 20 roll 90".
[[nodiscard]] Result<TableAngles> parse_mounting(const std::string& text);

}  // namespace mgtd::daemon::plan
