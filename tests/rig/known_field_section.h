// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tests/rig/scenario.h"
#include "tests/rig/section.h"

/// This reads what makes a table other than that of a turntable and a scalar magnetometer: [reference],
/// [cage] and [recording] of a scenario, and whether angles and total field are told.
namespace mgtd::rig {

/// After [scalar] and [sensors], whose total field, rate and correlation these may change.
void read_known_field(Section& cage, Section& reference, Section& recording, Scenario& s);

}  // namespace mgtd::rig
