// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/discovery/grammar_writer.h"

/// write_neighbour_families() adds to the grammar the formulas of what another sensor of the array reads;
/// there are none where the array has one sensor.
namespace mgtd::calib::discovery {

void write_neighbour_families(GrammarWriter& out);

}  // namespace mgtd::calib::discovery
