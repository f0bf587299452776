// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/discovery/chosen_law.h"
#include "calib/discovery/noise_in_force.h"

/// finding_of() decides the finding of discover() from the laws that were found in a run and from what is
/// left after them.
namespace mgtd::calib::discovery {

/// A recording has one sample a pose, and samples that follow one another are no replicates: what drifts for
/// a while, whatever its cause, looks like a law of time or of anything else that drifts.
[[nodiscard]] bool may_be_drift(const NoiseInForce& in_force, const ChosenLaw& first);

struct JudgedLaws {
  LawFinding finding{LawFinding::pass};
  LawFindingReason reason{};
};
/// `report`: with what is left after the laws. What must stand out does so of all `looks` together; what is
/// left counts as a single look finds it, because that takes a name away.
[[nodiscard]] JudgedLaws finding_of(const NoiseInForce& in_force, const std::vector<ChosenLaw>& laws,
                                    const DiscoveryReport& report, int looks);

}  // namespace mgtd::calib::discovery
