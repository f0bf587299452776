// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "tests/rig/scenario.h"
#include "tests/rig/survey.h"

/// This spoils rows of a table after everything was measured.
namespace mgtd::rig {

/// The sensors from 2 on get the rows of other poses, each in an order of its own.
void turn_apart(Survey& survey, std::uint64_t seed);
/// What went wrong with the readings of some rows.
void spoil(Survey& survey, const GrossReading& gross, const Scenario& scenario);

}  // namespace mgtd::rig
