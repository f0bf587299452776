// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/criticism/tests/score.h"

/// refine() looks for the best value of a searched number between the values that were tried. An alarm is
/// raised from the tried values alone, because its chance is counted with them; a name is given with the
/// number refined, because a law that is tried beside its true number falls behind others that have none.
namespace mgtd::calib::criticism::tests {

/// Halves the distance to the neighbours of the winner a few times and adds what was tried to the family.
/// Nothing happens to a family without a number that can be refined.
void refine(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
            const Residual& residual, const NoiseReference& noise, ScoredFamily& family);

/// Tries every instant between two poses that was not tried, and counts them as so many more questions.
/// Beside noise that remembers the pose before, a step shows between the two poses that it comes between, and
/// beside them hardly at all. Nothing happens to a family without instants, nor in a run of thousands of
/// poses.
void try_every_instant(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
                       const Residual& residual, const NoiseReference& noise, ScoredFamily& family);

/// Adds the dipole at its best place to a family that has one. It is scored with moment and place as six
/// numbers (dipole_search.h): every gradient is that of some dipole far away, and the sixth number must pay.
void refine_place(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
                  const Residual& residual, const NoiseReference& noise, ScoredFamily& family);

/// Adds a dipole at its place, with its own best moment, to a family that has one, as its winner.
void put_at_place(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
                  const Residual& residual, const NoiseReference& noise, const effects::EffectPtr& dipole,
                  ScoredFamily& family);

}  // namespace mgtd::calib::criticism::tests
