// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tests/rig/noise.h"
#include "tests/rig/section.h"

/// This reads the noise of a scenario: keys of [sensors] and of [visit]. An absent key leaves its value as it
/// is.
namespace mgtd::rig {

void read_sample_noise(Section& sensors, SampleNoise& noise);
void read_visit_noise(Section& visit, VisitNoise& noise);

}  // namespace mgtd::rig
