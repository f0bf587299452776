// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/discovery/grammar_writer.h"

/// Formulas of what another sensor of the array reads; none where the array has one sensor.
namespace mgtd::calib::discovery {

void write_neighbour_families(GrammarWriter& out);

}  // namespace mgtd::calib::discovery
