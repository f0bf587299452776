// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/discovery/grammar_writer.h"

/// write_reading_families() adds to the grammar the formulas of what the sensor itself reads, now and at the
/// pose before.
namespace mgtd::calib::discovery {

void write_reading_families(GrammarWriter& out);

}  // namespace mgtd::calib::discovery
