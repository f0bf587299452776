// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/fit/joint/joint_setup.h"

/// profile_search() finds the numbers of effects that a linear fit cannot estimate (EffectFamily::scan: the
/// width of a hysteresis, the time of a step, the place of a dipole) by profile likelihood: those that a spec
/// leaves out are searched, those it gives are kept.
///
/// One fit sets weights and outlier nodes; then the scanned values are tried with these held, all other
/// unknowns refitted, and a smooth number is refined between the neighbours of the best by golden section.
/// Several searched effects take turns, twice. A time is also searched with the readings that the first fit
/// left out back in: the value counts whose fit leaves least, each reading left out as five standard
/// deviations.
namespace mgtd::calib::fit::joint {

/// The effects of `options` with their numbers. Refuses what a fit refuses.
[[nodiscard]] Result<std::vector<effects::EffectPtr>> profile_search(const PoseTable& table,
                                                                     const JointOptions& options);

}  // namespace mgtd::calib::fit::joint
