// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "calib/criticism/tests/candidate.h"

/// next_measurements() finds which further measurements would tell two effects apart.
///
/// An action is a set of poses that could be added to the run: some of its own attitudes again, under other
/// conditions. Their rows of the fit need no readings, so the distance
///     lambda_ab = |(I - P_b) z_a gamma_a|^2
/// of the two effects with these poses, at the size that was found, is known before anything is measured, and
/// with it the probability Phi(sqrt(lambda_ab)/2) that the right one of the two wins.
namespace mgtd::calib::design {

/// A further measurement that would settle between two effects.
struct NextMeasurement {
  std::string action{};
  double minutes{0};
  double p_right_before{0}, p_right_after{0};  ///< against the alternative that is hardest to tell from it
  std::optional<double> lambda_before{}, lambda_after{};  ///< where several formulas were asked about
};

struct NextMenu {
  double p_right_before{1};  ///< on the run as it is
  std::vector<NextMeasurement> steps{};
};

/// For the winner of a round against its possible alternatives (or its nearest one), best first; actions that
/// gain nothing, or no more than more of the same, are left out. `model`: the effects of the fit that the
/// round started from.
[[nodiscard]] NextMenu next_measurements(const PoseTable& table, const fit::joint::JointFit& fit,
                                         const fit::joint::JointOptions& options,
                                         const criticism::tests::Candidate& winner);

}  // namespace mgtd::calib::design
