// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/criticism/search/effect_search.h"
#include "calib/criticism/search/surrogates.h"

namespace mgtd::calib::criticism::search {

/// Takes back the rounds from the first surrogate on, says so in the notes, and closes the axis or the sensor
/// to names: what it misfits counts as its noise from now on, so that it does not bend what others know.
void take_back(const Surrogates& found, EffectSearch& search, ExplainReport& report);

}  // namespace mgtd::calib::criticism::search
