// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/discovery/grammar_writer.h"

/// write_scalar_families() adds to the grammar the formulas of one scalar: its curves, and what is special to
/// time, temperature, the angles and gravity.
namespace mgtd::calib::discovery {

void write_scalar_families(GrammarWriter& out);

}  // namespace mgtd::calib::discovery
