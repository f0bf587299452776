// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/discovery/grammar_writer.h"

/// write_gain_families() adds to the grammar the formulas of a gain: what the sensor reads, times a function
/// of a scalar, of time, of the temperature or of an angle.
namespace mgtd::calib::discovery {

void write_gain_families(GrammarWriter& out);

}  // namespace mgtd::calib::discovery
