// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/criticism/search/explain_report.h"
#include "calib/criticism/tests/criticism.h"

/// conclude() chooses the verdict of explain() (explain.h) from what the search found.
namespace mgtd::calib::criticism::search {

/// The residual that was asked about, and its noise.
struct Asked {
  double dof;
  tests::NoiseReference reference;
};

/// Whether what is left is more than ten times the noise, and neither wandering offsets nor revisits account
/// for it: the tests then take it for noise, and that none of them rejects says nothing.
[[nodiscard]] bool stays_far_above_noise(const ExplainReport& report, const tests::Criticism& last);

[[nodiscard]] Finding conclude(const ExplainReport& report, const Asked& first, const tests::Criticism& last,
                               std::vector<ExplainNote>& notes);

/// Whether the data have a fault that no effect explains: wiring, poses that contradict all others, or noise
/// that is stated wrongly. `notes` says which, and also whether the table is less accurate than the stated
/// `table_sd_rad`.
[[nodiscard]] bool bad_data(const fit::joint::JointFit& fit, const tests::Criticism& criticism,
                            double table_sd_rad, std::vector<ExplainNote>& notes);

/// Takes back all rounds of a recording of single samples, and says so in `notes`, where the laws
/// only describe: they took away less than half of the square of the residual and something else still stands
/// out; or they are steps that follow a curve, one axis with two of them, or steps alone that leave a
/// residual that still follows time. Beside a disturbance of which nothing is known, such a name comes by
/// chance. True where something was taken back: then what stood out is UNKNOWN, even where the laws left
/// nothing.
[[nodiscard]] bool take_back_what_describes_a_recording(ExplainReport& report, const tests::Criticism& last);

/// Where the dwells do not say how large the noise is, the excess that the candidates share is what the
/// rounds took away: the residual at their end stands for the noise. Nothing to share where nothing was
/// added.
void share_what_fell(ExplainReport& report);

}  // namespace mgtd::calib::criticism::search
