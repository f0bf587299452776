// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <set>
#include <string>

#include "calib/criticism/search/effect_search.h"
#include "calib/criticism/search/surrogates.h"

namespace mgtd::calib::criticism::search {

/// take_back() takes back the rounds from the first surrogate on, says so in the notes, and closes the axis
/// or the sensor to names: what it misfits counts as its noise from now on, so that it does not bend what
/// others know.
void take_back(const Surrogates& found, EffectSearch& search, ExplainReport& report);

/// Takes names back where laws of no library were found on the axes `closed`: all of them, if they leave more
/// than a tenth of the misfit and something is still rejected, since beside so much that is unknown a name
/// comes by chance; else, if they leave more than a hundredth, those from the first one on that acts on such
/// an axis, since it may describe the larger part of that law.
void take_back_beside_unknown_laws(const std::set<std::string>& closed, const tests::Criticism& last,
                                   ExplainReport& report);

/// Beside offsets that wander, takes the last rounds back as long as the fit does not find what they added: a
/// test, which knows the size of the wandering only to a fifth, can name effects that the fit, whose
/// uncertainties contain the wandering, does not confirm. `noise`: that of the last model. True where
/// something was taken back and nothing wandered before the first round: then something is missing, and the
/// wandering only describes it.
[[nodiscard]] bool take_back_lost_in_wandering(const tests::NoiseModel& noise, ExplainReport& report);

/// Rounds from the first on that may stay, where the last ones took next to nothing of a residual that is far
/// above the noise: the tests take such a residual for noise, and what stands out of it by less than eight
/// standard deviations may follow its shape by chance. `last`: the tests of the last model; a noise that
/// wanders is known, and then all may stay.
[[nodiscard]] std::size_t rounds_that_count(const ExplainReport& report, const tests::NoiseModel& last);

/// Takes the others back, says so in the notes, and judges the model without them.
void take_back_what_took_little(EffectSearch& search, ExplainReport& report);

/// An effect that is found again once the axis is closed was not a surrogate of its law: the notes do not say
/// so any more.
void keep_names_found_again(ExplainReport& report);

/// What could have stood in the place of a round and was added beside it, on one of its axes, is no
/// alternative to it any more: the run needs both.
void close_alternatives_that_were_added(ExplainReport& report);

}  // namespace mgtd::calib::criticism::search
