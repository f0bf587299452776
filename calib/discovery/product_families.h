// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/discovery/grammar_writer.h"

/// write_product_families() adds to the grammar the formulas that are products of two scalars or of first
/// harmonics, and the parity of the pose.
namespace mgtd::calib::discovery {

void write_product_families(GrammarWriter& out);

}  // namespace mgtd::calib::discovery
